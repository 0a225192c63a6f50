// The warnings of a fit: what its numbers cannot be trusted for.
#pragma once

#include <string>
#include <vector>

#include "fit/fit.h"

namespace gonio::fit {

/// One sentence for each doubt, the gravest first. `survey` is of the samples used.
std::vector<std::string> diagnose(const FitResult& result, const Box& box,
                                  const Identifiability& identifiability, const Survey& survey);

}  // namespace gonio::fit
