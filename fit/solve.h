// Levenberg-Marquardt (Ceres), from one start.
#pragma once

#include "fit/batch_model.h"
#include "fit/chunk_pass.h"
#include "fit/linear_system.h"
#include "fit/loss.h"
#include "fit/parameters.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {

struct Solution {
  ParameterValues values;
  /// The problem at `values`, amplitudes and shape together.
  LinearSystem system;
  double cost = 0;  // half the sum of squares, or of what the loss makes of them
  bool converged = false;
  int iterations = 0;
  /// Other minima that the data cannot tell from this one by their cost.
  std::vector<ParameterValues> rivals = {};
};

/// How far the last step may be from the next one: of logarithms of roughnesses, of angles in
/// radians.
inline constexpr double final_precision = 1e-9;
inline constexpr double start_precision = 1e-5;

/// Minimises over the box from `start`, whose shape must lie inside. Where the problem is
/// projectable (joint_system.h) the amplitudes are solved for and those of `start` play no part.
/// Roughnesses and other scales are walked in their logarithm, angles around their period.
Solution solve(const WeightedSamples& samples, const BatchModel& model, const Box& box,
               const ScaledLoss& loss, ParameterValues start, double precision,
               const PassOptions& passes);

}  // namespace gonio::fit
