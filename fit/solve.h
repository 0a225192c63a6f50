// Levenberg-Marquardt (Ceres) in the shape parameters, from one start.
#pragma once

#include <vector>

#include "fit/batch_model.h"
#include "fit/compression.h"
#include "fit/parameters.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {

struct Solution {
  ParameterValues values;
  /// The problem at `values`, with its derivatives.
  Compressed compressed;
  double cost = 0;  // half the sum of squares
  bool converged = false;
  int iterations = 0;
};

/// Minimises over the box from `shape`, which must lie inside. Roughnesses and other scales are
/// walked in their logarithm.
Solution solve(const WeightedSamples& samples, const BatchModel& model, const Box& box,
               std::vector<double> shape, const PassOptions& options);

}  // namespace gonio::fit
