#include "fit/uncertainty.h"

#include <Eigen/SVD>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "fit/chunk_pass.h"

namespace gonio::fit {
namespace {

/// Singular values below this share of the largest belong to combinations that the data does not
/// see: an error of rounding in it would become an error of 1e-16 / 1e-7 in the parameters.
constexpr double singular_threshold = 1e-7;
/// An unknown takes part in an undetermined combination if its share of it is above this.
constexpr double participation = 0.05;

/// An amplitude below this share of what the data could show is rounding.
constexpr double negligible_share = 1e-10;

/// True if the amplitude contributes nothing to a channel but rounding.
bool is_negligible(const Compressed& compressed, double amplitude, Eigen::Index basis,
                   Eigen::Index channel) {
  const double data =
      std::hypot(compressed.projected.col(channel).norm(), compressed.unreachable[channel]);
  return std::abs(amplitude) * compressed.factor(channel).col(basis).norm() <=
         negligible_share * data;
}

/// The amplitudes with the negligible ones set to 0.
Eigen::MatrixXd significant_amplitudes(const Compressed& compressed,
                                       const Eigen::MatrixXd& amplitudes) {
  Eigen::MatrixXd significant = amplitudes;
  for (Eigen::Index c = 0; c < amplitudes.cols(); ++c) {
    for (Eigen::Index k = 0; k < amplitudes.rows(); ++k) {
      if (is_negligible(compressed, amplitudes(k, c), k, c)) significant(k, c) = 0;
    }
  }
  return significant;
}

/// The Jacobian of the compressed rows by every unknown, [channel * rows + row, unknown].
Eigen::MatrixXd full_jacobian(const Compressed& compressed, const BatchModel& model,
                              const Eigen::MatrixXd& amplitudes,
                              std::span<const Unknown> unknowns) {
  const Eigen::Index rows = compressed.projected.rows();
  const Eigen::Index channels = compressed.projected.cols();
  const auto amplitude_count = Eigen::Index(model.amplitude_count());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows * channels, Eigen::Index(unknowns.size()));
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const Unknown& unknown = unknowns[u];
    auto column = jacobian.col(Eigen::Index(u));
    if (!unknown.is_shape) {
      const auto c = Eigen::Index(unknown.channel);
      column.segment(c * rows, rows) = compressed.factor(c).col(Eigen::Index(unknown.index));
      continue;
    }
    for (std::size_t d = 0; d < model.derivatives().size(); ++d) {
      const BatchModel::Derivative derivative = model.derivatives()[d];
      if (derivative.shape != unknown.index) continue;
      for (Eigen::Index c = 0; c < channels; ++c) {
        column.segment(c * rows, rows) +=
            amplitudes(Eigen::Index(derivative.amplitude), c) *
            compressed.factor(c).col(amplitude_count + Eigen::Index(d));
      }
    }
  }
  return jacobian;
}

/// The scores of a chunk's samples: row r holds sum over channels of residual times gradient.
/// Channels of one sample are summed first, so that they may err together.
void write_scores(const SampleChunk& chunk, const Eigen::MatrixXd& columns, const BatchModel& model,
                  const ParameterValues& values, std::span<const Unknown> unknowns,
                  bool shared_factors, Eigen::MatrixXd& scores) {
  const auto rows = Eigen::Index(chunk.directions.count);
  const auto amplitude_count = Eigen::Index(model.amplitude_count());
  const auto basis = columns.topLeftCorner(rows, amplitude_count);
  // residual * factor^2, [row, channel].
  Eigen::MatrixXd weighted = chunk.values.topRows(rows) - basis * values.amplitudes;
  for (Eigen::Index c = 0; c < weighted.cols(); ++c) {
    const auto factor = chunk.factors.col(shared_factors ? 0 : c).head(rows).array();
    weighted.col(c).array() *= factor * factor;
  }
  scores.topRows(rows).setZero();
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    const Unknown& unknown = unknowns[u];
    auto score = scores.col(Eigen::Index(u)).head(rows);
    if (!unknown.is_shape) {
      score = basis.col(Eigen::Index(unknown.index))
                  .cwiseProduct(weighted.col(Eigen::Index(unknown.channel)));
      continue;
    }
    for (std::size_t d = 0; d < model.derivatives().size(); ++d) {
      const BatchModel::Derivative derivative = model.derivatives()[d];
      if (derivative.shape != unknown.index) continue;
      const Eigen::VectorXd amplitude =
          values.amplitudes.row(Eigen::Index(derivative.amplitude)).transpose();
      score += columns.col(amplitude_count + Eigen::Index(d))
                   .head(rows)
                   .cwiseProduct(weighted * amplitude);
    }
  }
}

/// The sum over the samples of their scores' outer products.
Eigen::MatrixXd score_products(const WeightedSamples& samples, const BatchModel& model,
                               const ParameterValues& values, std::span<const Unknown> unknowns,
                               const PassOptions& passes) {
  const auto count = Eigen::Index(unknowns.size());
  struct State {
    Eigen::MatrixXd sum, columns, scores;
  };
  const std::vector<State> parts = chunk_pass(
      samples, passes,
      [&] {
        return State{Eigen::MatrixXd::Zero(count, count),
                     Eigen::MatrixXd(chunk_rows, Eigen::Index(model.column_count(true))),
                     Eigen::MatrixXd(chunk_rows, count)};
      },
      [&](const SampleChunk& chunk, State& state) {
        model.evaluate(chunk.directions, values.shape, true, state.columns);
        write_scores(chunk, state.columns, model, values, unknowns, samples.shared_factors(),
                     state.scores);
        const auto used = state.scores.topRows(Eigen::Index(chunk.directions.count));
        state.sum.selfadjointView<Eigen::Lower>().rankUpdate(used.transpose());
      });
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(count, count);
  for (const State& part : parts) total += part.sum;
  return total.selfadjointView<Eigen::Lower>();
}

/// The 97.5 % quantile that an interval takes.
double quantile_975(Covariance kind, double freedom, const WeightedSamples& samples, double rank) {
  if (kind == Covariance::known_sigma) return 1.959963984540054;  // the normal distribution's
  // The channels of a sample may err together: for the sandwich only samples count, and of the
  // unknowns those that one channel sees.
  const double channels = double(samples.channel_count());
  const double sample_freedom = double(samples.used_samples()) - std::ceil(rank / channels);
  const double degrees = kind == Covariance::sandwich ? std::min(freedom, sample_freedom) : freedom;
  return boost::math::quantile(boost::math::students_t(std::max(degrees, 1.0)), 0.975);
}

Covariance kind_for(const Options& options, const WeightedSamples& samples, bool misfit) {
  if (options.covariance != Covariance::automatic) return options.covariance;
  // A weight beside sigma says that a sample counts more than its noise tells.
  return options.metric == Metric::chi2 && !misfit && !samples.table().has_weight()
             ? Covariance::known_sigma
             : Covariance::sandwich;
}

}  // namespace

Identifiability::Identifiability(const Compressed& compressed, const BatchModel& model,
                                 const Box& box, const ParameterValues& values,
                                 std::span<const Unknown> unknowns) {
  const Eigen::MatrixXd amplitudes = significant_amplitudes(compressed, values.amplitudes);
  const Eigen::MatrixXd jacobian = full_jacobian(compressed, model, amplitudes, unknowns);
  absent_terms_.assign(model.model().terms().size(), true);
  for (std::size_t k = 0; k < model.amplitude_count(); ++k) {
    if ((amplitudes.row(Eigen::Index(k)).array() != 0).any()) {
      absent_terms_[model.model().amplitudes()[k].term] = false;
    }
  }
  inverse_ = Eigen::MatrixXd::Zero(jacobian.cols(), jacobian.cols());
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    if (!box.is_fixed(unknowns[u])) free_.push_back(u);
  }
  if (free_.empty()) return;

  const auto count = Eigen::Index(free_.size());
  Eigen::MatrixXd scaled(jacobian.rows(), count);
  Eigen::VectorXd norms(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto column = jacobian.col(Eigen::Index(free_[std::size_t(k)]));
    norms[k] = column.stableNorm();
    if (norms[k] > 0) {
      scaled.col(k) = column / norms[k];
    } else {
      scaled.col(k).setZero();
      norms[k] = 1;
    }
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::ColPivHouseholderQRPreconditioner> svd(
      scaled, Eigen::ComputeThinV | Eigen::ComputeThinU);
  const Eigen::VectorXd& singular = svd.singularValues();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index s = 0; s < singular.size(); ++s) {
    const auto direction = svd.matrixV().col(s);
    if (singular[s] > singular_threshold * singular[0]) {
      inverse += direction * direction.transpose() / (singular[s] * singular[s]);
      continue;
    }
    std::vector<std::size_t> group;
    for (Eigen::Index k = 0; k < count; ++k) {
      if (std::abs(direction[k]) > participation) group.push_back(free_[std::size_t(k)]);
    }
    undetermined_.push_back(std::move(group));
  }
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b < count; ++b) {
      inverse_(Eigen::Index(free_[std::size_t(a)]), Eigen::Index(free_[std::size_t(b)])) =
          inverse(a, b) / (norms[a] * norms[b]);
    }
  }
}

bool Identifiability::is_undetermined(std::size_t unknown) const {
  return std::any_of(undetermined_.begin(), undetermined_.end(), [&](const auto& group) {
    return std::find(group.begin(), group.end(), unknown) != group.end();
  });
}

Uncertainty uncertainty_of(const Solution& solution, const Identifiability& identifiability,
                           const WeightedSamples& samples, const BatchModel& model, const Box& box,
                           std::span<const Unknown> unknowns, const Options& options,
                           const PassOptions& passes) {
  const double rank = double(identifiability.rank());
  const double values = double(samples.used_values());
  const double freedom = values - rank;
  const double variance = freedom > 0 ? 2 * solution.cost / freedom : 0;

  Uncertainty result;
  if (options.metric == Metric::chi2 && freedom > 0) {
    result.reduced_chi2 = variance;
    result.misfit = variance > 1 + 5 * std::sqrt(2 / freedom);
  }
  result.kind = kind_for(options, samples, result.misfit);

  Eigen::MatrixXd covariance = identifiability.inverse();
  if (result.kind == Covariance::residual) {
    covariance *= variance;
  } else if (result.kind == Covariance::sandwich) {
    const Eigen::MatrixXd meat = score_products(samples, model, solution.values, unknowns, passes);
    // The usual small-sample factor of a covariance clustered by sample (Cameron & Miller 2015).
    const double clusters = double(samples.used_samples());
    const double small_sample =
        freedom > 0 && clusters > 1 ? clusters / (clusters - 1) * (values - 1) / freedom : 1;
    covariance = small_sample * covariance * meat * covariance;
  }

  const std::size_t count = unknowns.size();
  result.stddev.resize(count);
  result.interval95.resize(count);
  result.correlation.assign(count, std::vector<std::optional<double>>(count));
  if (freedom <= 0 && result.kind != Covariance::known_sigma) return result;
  const double quantile = quantile_975(result.kind, freedom, samples, rank);
  for (std::size_t u = 0; u < count; ++u) {
    if (box.is_fixed(unknowns[u]) || identifiability.is_undetermined(u)) continue;
    const auto i = Eigen::Index(u);
    const double stddev = std::sqrt(std::max(covariance(i, i), 0.0));
    const double value = solution.values[unknowns[u]];
    result.stddev[u] = stddev;
    result.interval95[u] = {std::max(value - quantile * stddev, box.lower(unknowns[u])),
                            std::min(value + quantile * stddev, box.upper(unknowns[u]))};
  }
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      if (!result.stddev[a] || !result.stddev[b]) continue;
      const double product = *result.stddev[a] * *result.stddev[b];
      result.correlation[a][b] =
          a == b ? 1.0
          : product > 0
              ? std::clamp(covariance(Eigen::Index(a), Eigen::Index(b)) / product, -1.0, 1.0)
              : 0.0;
    }
  }
  return result;
}

}  // namespace gonio::fit
