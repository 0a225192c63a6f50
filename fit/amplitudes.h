// Amplitudes for a given shape where they are no linear least-squares problem: for start values.
#pragma once

#include <span>
#include <vector>

#include "fit/batch_model.h"
#include "fit/options.h"
#include "fit/parameters.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {

struct ShapeCost {
  Eigen::MatrixXd amplitudes;  // [amplitude, channel]
  /// Comparable between shapes: the weighted sum of squared residuals under the metric, or, with a
  /// robust loss, of their magnitudes, limited: these need no scale and do not mind outliers.
  double cost;
};

/// Near the best amplitudes at a shape, by a few reweighted linear problems. `chunks` are all those
/// of `samples`.
ShapeCost best_amplitudes(const WeightedSamples& samples, std::span<const SampleChunk> chunks,
                          const BatchModel& model, const Box& box, std::span<const double> shape,
                          Loss loss);

}  // namespace gonio::fit
