// Where the amplitudes cannot be projected out - a metric that is not linear in the model, or a
// loss other than the square - the problem is solved in amplitudes and shape together.
#pragma once

#include "fit/batch_model.h"
#include "fit/chunk_pass.h"
#include "fit/linear_system.h"
#include "fit/loss.h"
#include "fit/parameters.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {

/// True if metric and loss leave a least-squares problem that is linear in the amplitudes.
bool is_projectable(Metric metric, Loss loss);

/// The problem's first-order system at the given values, in one pass over the samples. A robust
/// loss enters exactly: cost and gradient are those of the full problem. Rows are weighed by
/// sqrt(rho'), and then turned and shrunk so that J'J is the loss' own curvature where that is
/// positive, which takes few steps; what the loss costs beyond them is a constant row.
LinearSystem joint_system_of(const WeightedSamples& samples, const BatchModel& model,
                             const ParameterValues& values, const ScaledLoss& loss,
                             const PassOptions& passes);

}  // namespace gonio::fit
