// How well a model predicts incidence angles that it was not fitted to.
#pragma once

#include <optional>

#include "fit/fit.h"

namespace gonio::fit {

/// Fits the model anew to all samples but those of a band of incidence angles, and measures the
/// error there; band after band, until every sample was held out once. The bands hold about equally
/// many of the samples, and no angle is in two of them: at most 5, one per angle where the table
/// has fewer. None if all samples have one incidence angle, or too few remain for a fit. `options`
/// are those that gave `result`; a loss keeps the scale that was found there.
std::optional<HeldOut> held_out_errors(const FitResult& result, const table::SampleTable& table,
                                       const Options& options);

}  // namespace gonio::fit
