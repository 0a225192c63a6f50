// The warnings of a fit: what its numbers cannot be trusted for.
#pragma once

#include <string>
#include <vector>

#include "fit/fit.h"

namespace gonio::fit {

/// One sentence for each doubt, the gravest first. `most_grazing_wi`: of the samples used, the
/// light that comes at the largest angle.
std::vector<std::string> diagnose(const FitResult& result, const Box& box,
                                  const Identifiability& identifiability,
                                  const brdf::Direction<double>& most_grazing_wi);

}  // namespace gonio::fit
