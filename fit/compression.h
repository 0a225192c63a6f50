// Exact compression of the least-squares problem: Levenberg-Marquardt sees the rows [B D y] only
// through their inner products, so that the N rows of a table may be replaced by the triangular
// factor of their QR decomposition, chunk by chunk (TSQR: Demmel et al. 2012). Same steps, same
// cost, memory independent of N, and no squared condition number as normal equations have.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "fit/batch_model.h"
#include "fit/chunk_pass.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {

/// For each channel c: |B beta + D x - y_c|^2 over all weighted samples
///   = |factor(c) (beta; x) - projected.col(c)|^2 + unreachable(c)^2   for any beta and x,
/// with the columns [B D] of BatchModel.
struct Compressed {
  /// Upper triangular; one for all channels, or one per channel.
  std::vector<Eigen::MatrixXd> factors;
  Eigen::MatrixXd projected;    // [column, channel]
  Eigen::VectorXd unreachable;  // [channel]

  const Eigen::MatrixXd& factor(Eigen::Index channel) const {
    return factors.size() == 1 ? factors.front() : factors[std::size_t(channel)];
  }
};

/// Compresses the samples at the given shape in one pass over the table.
Compressed compress(const WeightedSamples& samples, const BatchModel& model,
                    std::span<const double> shape, bool with_derivatives,
                    const PassOptions& options);

/// The same of chunks that were gathered before.
Compressed compress(const WeightedSamples& samples, std::span<const SampleChunk> chunks,
                    const BatchModel& model, std::span<const double> shape, bool with_derivatives);

}  // namespace gonio::fit
