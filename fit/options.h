// What a user can ask of a fit.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "table/sample_table.h"

namespace gonio::fit {

/// What is minimised: the sum of squares (or of another loss) of the residual
///   l2         model - f
///   cosine_l2  (model - f) cos_i                      (Ngan, Durand & Matusik 2005)
///   log        difference of ln(1 + max(0, f cos_i))  (Loew et al. 2012)
///   cube_root  difference of cbrt(max(0, f cos_i))
///   relative   (model - f) / max(|f|, 1 % of the channel's median |f| that is not 0)
///   chi2       (model - f) / sigma
/// each times the sample's weight where the table carries weights.
enum class Metric { l2, cosine_l2, log, cube_root, relative, chi2 };
std::string_view name(Metric metric);
/// Throws std::invalid_argument that lists the metrics.
Metric metric_from_name(std::string_view name);

/// What a residual r costs, in place of r^2 / 2, with s = (r / scale)^2:
///   none    scale^2 s / 2
///   huber   scale^2 (s / 2 up to s = 1, sqrt(s) - 1/2 beyond)     (Huber 1964)
///   cauchy  scale^2 ln(1 + s) / 2
///   tukey   scale^2 (1 - max(0, 1 - s)^3) / 6                     (Beaton & Tukey 1974)
/// Outliers pull less, with tukey not at all beyond the scale.
enum class Loss { none, huber, cauchy, tukey };
std::string_view name(Loss loss);
/// Throws std::invalid_argument that lists the losses.
Loss loss_from_name(std::string_view name);

/// Where the covariance of the parameters comes from, J being the Jacobian of the residuals r:
///   known_sigma  (J'J)^-1: the residuals have unit variance (chi2 with honest sigma)
///   residual     (J'J)^-1 times the residual variance: equal, unknown variance
///   sandwich     (J'J)^-1 (sum of scores' outer products) (J'J)^-1 (White 1980): valid for
///                unequal variance and for a model that does not fit within the noise; the
///                channels of one sample may err together
///   automatic    known_sigma for chi2, unless the residuals are far larger than sigma or the table
///                carries weights besides; sandwich else
enum class Covariance { automatic, known_sigma, residual, sandwich };
std::string_view name(Covariance covariance);
/// Throws std::invalid_argument that lists the kinds.
Covariance covariance_from_name(std::string_view name);

/// sigma^2 = (relative * f)^2 + absolute^2, f being the model's value: with the measured value
/// instead, low readings would count for more and pull every amplitude down by 2 relative^2.
struct Noise {
  double relative;  // 1
  double absolute;  // 1/sr
};

/// One parameter, or one channel's part of it, by name: "alpha_x", "rho_d" (every channel),
/// "rho_d.R" (one channel).
struct ParameterSetting {
  std::string parameter;
  double value;
};

struct ParameterBounds {
  std::string parameter;
  double lower, upper;
};

/// How far a fit has come: the number of the pass over the table, from 1, and the share of it
/// that is done. Called from one thread at a time, not always the same one.
using Progress = std::function<void(int pass, double share)>;

struct Options {
  Metric metric = Metric::cosine_l2;
  Loss loss = Loss::none;
  /// The loss' scale in the unit of the metric's residual. Without it: the residuals' standard
  /// deviation as their median magnitude tells it (1.4826 times it), times what makes the loss 95 %
  /// efficient for normal noise: 1.345 (huber), 2.385 (cauchy), 4.685 (tukey); to 0.1 %, as it and
  /// the residuals depend on each other.
  std::optional<double> loss_scale = {};
  Covariance covariance = Covariance::automatic;
  /// Samples with a polar angle beyond it are left out (inclusive, + 1e-6 deg).
  double max_theta_deg = 80;
  /// For chi2: instead of the table's sigma.
  std::optional<Noise> noise = {};
  std::vector<ParameterSetting> fixed = {};
  /// Shape parameters from which the search starts as well. Amplitudes need none.
  std::vector<ParameterSetting> start = {};
  std::vector<ParameterBounds> bounds = {};
  /// rho_s = 1 - rho_d in every channel: nothing is absorbed.
  bool homogeneous = false;
  /// Only samples whose incidence angle is inside, or outside, a band.
  std::optional<table::IncidenceBand> incidence = {};
  /// 0: as many as the machine has. The result has the same bits for any number.
  int threads = 0;
  Progress progress = {};
};

}  // namespace gonio::fit
