#include "fit/uncertainty.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "fit/scale.h"

namespace gonio::fit {
namespace {

/// Singular values below this share of the largest belong to combinations that the data does not
/// see: an error of rounding in it would become an error of 1e-16 / 1e-7 in the parameters.
constexpr double singular_threshold = 1e-7;
/// An unknown takes part in an undetermined combination if its share of it is above this.
constexpr double participation = 0.05;

/// An amplitude below this share of what the data could show is rounding.
constexpr double negligible_share = 1e-10;

/// The amplitudes with the negligible ones set to 0: those that contribute nothing to a channel but
/// rounding.
Eigen::MatrixXd significant_amplitudes(const LinearSystem& system,
                                       const Eigen::MatrixXd& amplitudes) {
  Eigen::MatrixXd significant = amplitudes;
  for (Eigen::Index c = 0; c < amplitudes.cols(); ++c) {
    const ChannelSystem& channel = system[std::size_t(c)];
    const double data = (channel.residuals - channel.amplitude_jacobian * amplitudes.col(c)).norm();
    for (Eigen::Index k = 0; k < amplitudes.rows(); ++k) {
      const double share = std::abs(amplitudes(k, c)) * channel.amplitude_jacobian.col(k).norm();
      if (share <= negligible_share * data) significant(k, c) = 0;
    }
  }
  return significant;
}

/// Amplitudes are walked as they are.
brdf::Scale scale_of(const brdf::Model& model, const Unknown& unknown) {
  return unknown.is_shape ? model.shape()[unknown.index].descriptor.scale : brdf::Scale::linear;
}

/// A large change of a shape parameter.
double natural_size(const brdf::Model& model, const Unknown& unknown,
                    const ParameterValues& values) {
  const brdf::Parameter& descriptor = model.shape()[unknown.index].descriptor;
  return is_logarithmic(descriptor.scale) ? parameter_slope(descriptor.scale, values[unknown])
                                          : (descriptor.upper - descriptor.lower) / 2;
}

/// The Jacobian of the rows by every unknown, [channel * rows + row, unknown]; the shape of terms
/// that are absent has no influence.
Eigen::MatrixXd full_jacobian(const LinearSystem& system, const brdf::Model& model,
                              const std::vector<bool>& absent_terms,
                              std::span<const Unknown> unknowns) {
  const Eigen::Index rows = system.front().residuals.size();
  Eigen::MatrixXd jacobian =
      Eigen::MatrixXd::Zero(rows * Eigen::Index(system.size()), Eigen::Index(unknowns.size()));
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const Unknown& unknown = unknowns[u];
    auto column = jacobian.col(Eigen::Index(u));
    if (!unknown.is_shape) {
      column.segment(Eigen::Index(unknown.channel) * rows, rows) =
          system[unknown.channel].amplitude_jacobian.col(Eigen::Index(unknown.index));
      continue;
    }
    if (absent_terms[model.shape()[unknown.index].term]) continue;
    for (std::size_t c = 0; c < system.size(); ++c) {
      column.segment(Eigen::Index(c) * rows, rows) =
          system[c].shape_jacobian.col(Eigen::Index(unknown.index));
    }
  }
  return jacobian;
}

/// How all the unknowns move with the free ones, [unknown, free].
Eigen::MatrixXd freedom_of(std::span<const Unknown> unknowns, const Box& box,
                           std::span<const std::size_t> free) {
  Eigen::MatrixXd freedom =
      Eigen::MatrixXd::Zero(Eigen::Index(unknowns.size()), Eigen::Index(free.size()));
  for (std::size_t f = 0; f < free.size(); ++f) {
    const Unknown& moved = unknowns[free[f]];
    freedom(Eigen::Index(free[f]), Eigen::Index(f)) = 1;
    if (moved.is_shape) continue;
    const auto& indices = box.amplitudes.free;
    const auto column =
        std::find(indices.begin(), indices.end(), Eigen::Index(moved.index)) - indices.begin();
    for (std::size_t u = 0; u < unknowns.size(); ++u) {
      if (unknowns[u].is_shape || unknowns[u].channel != moved.channel) continue;
      freedom(Eigen::Index(u), Eigen::Index(f)) =
          box.amplitudes.map(Eigen::Index(unknowns[u].index), column);
    }
  }
  return freedom;
}

/// The 97.5 % quantile of the normal distribution, or of Student's t.
double quantile_975(double degrees) {
  if (std::isinf(degrees)) return 1.959963984540054;
  return boost::math::quantile(boost::math::students_t(degrees), 0.975);
}

/// value -+ half_width, on a quadratic scale of the square.
std::pair<double, double> around(double value, double half_width, brdf::Scale scale) {
  if (scale != brdf::Scale::quadratic) return {value - half_width, value + half_width};
  const double half = 2 * value * half_width;
  return {std::sqrt(std::max(value * value - half, 0.0)), std::sqrt(value * value + half)};
}

/// Half the width of the interval of one standard deviation: on a quadratic scale the data tell
/// that of the square, which is another near 0 only.
double stddev_of(double value, double stddev, brdf::Scale scale) {
  const auto [from, to] = around(value, stddev, scale);
  return (to - from) / 2;
}

/// Cut at the bounds; that of an angle that goes round runs past them, up to a whole period.
std::pair<double, double> interval_of(double value, double half_width, const brdf::Model& model,
                                      const Box& box, const Unknown& unknown) {
  const double lower = box.lower(unknown);
  const double upper = box.upper(unknown);
  if (goes_round(model, box, unknown)) {
    const double half = std::min(half_width, (upper - lower) / 2);
    return {value - half, value + half};
  }
  const auto [from, to] = around(value, half_width, scale_of(model, unknown));
  return {std::max(from, lower), std::min(to, upper)};
}

/// The degrees of freedom of the intervals' distribution; infinity for the normal one.
double freedom_of_intervals(Covariance kind, double freedom, const WeightedSamples& samples,
                            double rank) {
  if (kind == Covariance::known_sigma) return std::numeric_limits<double>::infinity();
  // The channels of a sample may err together: for the sandwich only samples count, and of the
  // unknowns those that one channel sees.
  const double channels = double(samples.channel_count());
  const double sample_freedom = double(samples.survey().used_samples) - std::ceil(rank / channels);
  return std::max(kind == Covariance::sandwich ? std::min(freedom, sample_freedom) : freedom, 1.0);
}

Covariance kind_for(const Options& options, const WeightedSamples& samples, bool misfit) {
  if (options.covariance != Covariance::automatic) return options.covariance;
  // A weight beside sigma says that a sample counts more than its noise tells.
  return options.metric == Metric::chi2 && options.loss == Loss::none && !misfit &&
                 !samples.has_weight()
             ? Covariance::known_sigma
             : Covariance::sandwich;
}

}  // namespace

Identifiability::Identifiability(const LinearSystem& system, const brdf::Model& model,
                                 const Box& box, const ParameterValues& values,
                                 std::span<const Unknown> unknowns) {
  const Eigen::MatrixXd amplitudes = significant_amplitudes(system, values.amplitudes);
  for (const brdf::TermEntry* term : model.terms()) {
    absent_terms_.push_back(!brdf::has_fixed_part(*term));
  }
  for (Eigen::Index k = 0; k < amplitudes.rows(); ++k) {
    if ((amplitudes.row(k).array() != 0).any()) {
      absent_terms_[model.amplitudes()[std::size_t(k)].term] = false;
    }
  }
  const auto unknown_count = Eigen::Index(unknowns.size());
  inverse_ = Eigen::MatrixXd::Zero(unknown_count, unknown_count);
  determined_ = Eigen::MatrixXd::Zero(unknown_count, 0);
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    if (!box.is_fixed(unknowns[u]) && !unknowns[u].dependent) free_.push_back(u);
  }
  if (free_.empty()) return;

  const Eigen::MatrixXd freedom = freedom_of(unknowns, box, free_);
  Eigen::MatrixXd jacobian = full_jacobian(system, model, absent_terms_, unknowns) * freedom;
  const Eigen::Index count = jacobian.cols();
  const double negligible = negligible_share * norm_of_data(system, values.amplitudes);
  Eigen::VectorXd norms(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    // The angle of a lobe without direction moves nothing but roundings.
    const Unknown& unknown = unknowns[free_[std::size_t(k)]];
    if (unknown.is_shape &&
        jacobian.col(k).stableNorm() * natural_size(model, unknown, values) <= negligible) {
      jacobian.col(k).setZero();
    }
    const double norm = jacobian.col(k).stableNorm();
    norms[k] = norm > 0 ? norm : 1;
    jacobian.col(k) /= norms[k];
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::ColPivHouseholderQRPreconditioner> svd(
      jacobian, Eigen::ComputeThinV | Eigen::ComputeThinU);
  const Eigen::VectorXd& singular = svd.singularValues();
  Eigen::MatrixXd combinations(count, count);
  Eigen::Index determined = 0;
  for (Eigen::Index s = 0; s < singular.size(); ++s) {
    const auto direction = svd.matrixV().col(s);
    if (singular[s] > singular_threshold * singular[0]) {
      combinations.col(determined++) = (direction.array() / norms.array()) / singular[s];
      continue;
    }
    // Those that take part, and what depends on them.
    const Eigen::VectorXd part =
        freedom * (direction.array().abs() > participation).select(direction, 0).matrix();
    std::vector<std::size_t> group;
    for (std::size_t u = 0; u < unknowns.size(); ++u) {
      if (part[Eigen::Index(u)] != 0) group.push_back(u);
    }
    undetermined_.push_back(std::move(group));
  }
  determined_ = freedom * combinations.leftCols(determined);
  inverse_ = determined_ * determined_.transpose();
}

Eigen::MatrixXd Identifiability::inverse_of(const Eigen::MatrixXd& matrix) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(determined_.transpose() * matrix * determined_);
  if (factor.info() != Eigen::Success) return inverse_;
  return determined_ * factor.solve(determined_.transpose());
}

bool Identifiability::is_undetermined(std::size_t unknown) const {
  return std::any_of(undetermined_.begin(), undetermined_.end(), [&](const auto& group) {
    return std::find(group.begin(), group.end(), unknown) != group.end();
  });
}

Uncertainty uncertainty_kind(const Solution& solution, const Identifiability& identifiability,
                             const WeightedSamples& samples, const Options& options) {
  const double freedom = double(samples.survey().used_values) - double(identifiability.rank());
  Uncertainty result;
  if (options.metric == Metric::chi2 && options.loss == Loss::none && freedom > 0) {
    result.reduced_chi2 = 2 * solution.cost / freedom;
    result.misfit = *result.reduced_chi2 > 1 + 5 * std::sqrt(2 / freedom);
  }
  result.kind = kind_for(options, samples, result.misfit);
  return result;
}

void complete_uncertainty(const Solution& solution, const Identifiability& identifiability,
                          const WeightedSamples& samples, const brdf::Model& model, const Box& box,
                          std::span<const Unknown> unknowns, const Assessment& assessment,
                          Uncertainty& result) {
  const double rank = double(identifiability.rank());
  const double values = double(samples.survey().used_values);
  const double freedom = values - rank;

  result.covariance = identifiability.inverse();
  if (result.kind == Covariance::residual) {
    result.covariance *= freedom > 0 ? 2 * solution.cost / freedom : 0;
  } else if (result.kind == Covariance::sandwich) {
    // With a robust loss the curvature of the cost is not J'J: Huber (1981), 6.3.
    const Eigen::MatrixXd bread = assessment.curvature.size() > 0
                                      ? identifiability.inverse_of(assessment.curvature)
                                      : identifiability.inverse();
    // The usual small-sample factor of a covariance clustered by sample (Cameron & Miller 2015).
    const double clusters = double(samples.survey().used_samples);
    const double small_sample =
        freedom > 0 && clusters > 1 ? clusters / (clusters - 1) * (values - 1) / freedom : 1;
    result.covariance = small_sample * bread * assessment.score_products * bread;
  }

  const std::size_t count = unknowns.size();
  result.stddev.resize(count);
  result.interval95.resize(count);
  result.correlation.assign(count, std::vector<std::optional<double>>(count));
  if (freedom <= 0 && result.kind != Covariance::known_sigma) return;
  result.degrees_of_freedom = freedom_of_intervals(result.kind, freedom, samples, rank);
  const double quantile = quantile_975(result.degrees_of_freedom);
  const Eigen::MatrixXd& covariance = result.covariance;
  for (std::size_t u = 0; u < count; ++u) {
    if (box.is_fixed(unknowns[u]) || identifiability.is_undetermined(u)) continue;
    const auto i = Eigen::Index(u);
    const double stddev = std::sqrt(std::max(covariance(i, i), 0.0));
    const double value = solution.values[unknowns[u]];
    result.stddev[u] = stddev_of(value, stddev, scale_of(model, unknowns[u]));
    result.interval95[u] = interval_of(value, quantile * stddev, model, box, unknowns[u]);
  }
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      if (!result.stddev[a] || !result.stddev[b]) continue;
      const double product = std::sqrt(covariance(Eigen::Index(a), Eigen::Index(a)) *
                                       covariance(Eigen::Index(b), Eigen::Index(b)));
      result.correlation[a][b] =
          a == b ? 1.0
          : product > 0
              ? std::clamp(covariance(Eigen::Index(a), Eigen::Index(b)) / product, -1.0, 1.0)
              : 0.0;
    }
  }
}

}  // namespace gonio::fit
