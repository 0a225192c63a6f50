// Which models a table can determine, and which of them fits best.
#pragma once

#include <string>
#include <vector>

#include "fit/fit.h"

namespace gonio::fit {

/// The models of brdf::model_names() whose parameters these directions could tell apart if the
/// material had them, e.g. no anisotropic one where the half vectors cover no azimuth. `excluded`
/// gets a sentence for each of the others.
std::vector<std::string> determinable_models(const table::SampleTable& table,
                                             const Options& options,
                                             std::vector<std::string>& excluded);

/// The order of a ranking: the smaller error under the metric first; of equals the one with fewer
/// unknowns.
bool ranks_before(const FitResult& a, const FitResult& b);

}  // namespace gonio::fit
