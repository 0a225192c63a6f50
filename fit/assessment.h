// What there is to say about given parameters, in one pass over the samples: the error under every
// metric, outliers, and the sums that the covariance is made of.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "fit/batch_model.h"
#include "fit/chunk_pass.h"
#include "fit/loss.h"
#include "fit/parameters.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {

/// Weighted root mean square over all used samples and channels of
///   l2         f - model                                     in 1/sr
///   cosine-l2  (f - model) cos_i                             in 1/sr
///   log        difference of ln(1 + max(0, f cos_i))         (Loew et al. 2012)
///   cube-root  difference of cbrt(max(0, f cos_i))
///   relative   (f - model) / max(|f|, 1 % of the channel's median |f| that is not 0)
/// in this order. The weights are the table's own, 1 where it carries none.
using ErrorList = std::vector<std::pair<std::string_view, double>>;

/// A value far from the model.
struct Outlier {
  std::size_t sample;  // in the table, from 0
  std::size_t channel;
  double residual;  // measured less fitted, in the metric's unit
};

struct Assessment {
  ErrorList errors;
  /// Root mean square of the metric's residuals, weighted by the table and by the loss.
  double metric_error = 0;
  /// The sums of weights that the squares were divided by.
  double weight = 0;
  double metric_weight = 0;
  std::size_t values = 0;  // measured, over all channels
  /// Sum over the samples of the outer products of their scores, [unknown, unknown]. Channels of
  /// one sample are summed first, so that they may err together.
  Eigen::MatrixXd score_products;
  /// Second derivatives of the cost as the loss makes them, [unknown, unknown]: the sum of
  /// (rho' + 2 s rho'') times the gradients' outer products. Empty without a loss.
  Eigen::MatrixXd curvature;
  /// Values with a residual beyond the threshold: how many, and the largest of them, the worst
  /// first.
  std::size_t outlier_count = 0;
  std::vector<Outlier> outliers;
  /// Per basis function, how many samples it lives in: (sum of b^2)^2 / (sum of b^4).
  Eigen::VectorXd seen_by;
  /// Sum over the values of ln(2 pi sigma^2), for chi2.
  double log_variance = 0;
};

/// At most this many outliers are listed unless more are asked for.
inline constexpr std::size_t most_outliers = 1000;

/// What is wanted of the pass.
struct AssessmentOptions {
  ScaledLoss loss = {};
  bool scores = false;
  /// Residuals beyond it are outliers; infinity: none are looked for.
  double outlier_threshold = std::numeric_limits<double>::infinity();
  std::size_t most_listed = most_outliers;
};

/// `floors` as WeightedSamples takes them, always needed here.
Assessment assess(const WeightedSamples& samples, const BatchModel& model,
                  const ParameterValues& values, std::span<const Unknown> unknowns,
                  std::span<const double> floors, const AssessmentOptions& options,
                  const PassOptions& passes);

}  // namespace gonio::fit
