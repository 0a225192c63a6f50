// How far residuals scatter, by their median magnitude: outliers do not move it.
#pragma once

#include "fit/batch_model.h"
#include "fit/chunk_pass.h"
#include "fit/parameters.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {

/// What a deviation is not to fall below, so that a table without noise has a scale too: 1e-10 of
/// the data's median magnitude under the metric. A few passes.
double least_deviation(const WeightedSamples& samples, const BatchModel& model,
                       const PassOptions& passes);

/// 1.4826 times the (weighted) median magnitude of the metric's residuals: the standard deviation
/// if they are normal; at least `least`. Two passes over the samples if it lies within a fifth of
/// `near`, else some more; a `near` of 0 says that nothing is known.
double robust_deviation(const WeightedSamples& samples, const BatchModel& model,
                        const ParameterValues& values, double near, double least,
                        const PassOptions& passes);

}  // namespace gonio::fit
