#include "fit/assessment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <tuple>

#include "fit/columns.h"
#include "fit/residual.h"

namespace gonio::fit {
namespace {

using brdf::Pack;

constexpr std::array<std::string_view, 5> error_names{"l2", "cosine-l2", "log", "cube-root",
                                                      "relative"};

/// Sums over values.
struct ErrorSums {
  std::array<double, error_names.size()> squares{};
  double weight = 0;
  double metric_square = 0;  // of the metric's residual, weighted by the loss as well
  double metric_weight = 0;

  void add(const ErrorSums& other) {
    for (std::size_t m = 0; m < squares.size(); ++m) squares[m] += other.squares[m];
    weight += other.weight;
    metric_square += other.metric_square;
    metric_weight += other.metric_weight;
  }
};

/// Where a value was measured its weight, else 0.
inline Pack weight_at(const ChannelColumns& in, std::size_t i) {
  return select(less(Pack(0), Pack::load(in.factors + i)), Pack::load(in.weights + i), Pack(0));
}

GONIO_FOR_EACH_CPU void add_errors(const ChannelColumns& in, double floor, ErrorSums& sums) {
  std::array<Pack, error_names.size()> squares;
  squares.fill(Pack(0));
  Pack weights(0);
  for (std::size_t i = 0; i < in.count; i += Pack::size) {
    const Pack f = Pack::load(in.values + i);
    const Pack model = Pack::load(in.model + i);
    const Pack cos_i = Pack::load(in.cos_i + i);
    const Pack weight = weight_at(in, i);
    const Pack one(1);
    const Pack plain = model - f;
    const std::array<Pack, error_names.size()> residuals{
        plain, plain * cos_i, LogResidual::of(f, model, cos_i, one).value,
        CubeRootResidual::of(f, model, cos_i, one).value, plain / larger(abs(f), Pack(floor))};
    for (std::size_t m = 0; m < residuals.size(); ++m) {
      squares[m] += weight * residuals[m] * residuals[m];
    }
    weights += weight;
  }
  for (std::size_t m = 0; m < squares.size(); ++m) sums.squares[m] += squares[m].sum();
  sums.weight += weights.sum();
}

/// What each row of a channel contributes.
struct RowColumns {
  alignas(64) std::array<double, chunk_rows> residuals;
  /// weight rho' r dr/dmodel: times the model's gradient, the score.
  alignas(64) std::array<double, chunk_rows> scores;
  /// weight (rho' + 2 s rho'') (dr/dmodel)^2.
  alignas(64) std::array<double, chunk_rows> curvatures;
};

template <class MetricResidual>
GONIO_FOR_EACH_CPU void write_rows(const ChannelColumns& in, const ScaledLoss& loss,
                                   RowColumns& out, ErrorSums& sums) {
  const Pack scale(loss.scale);
  Pack square(0);
  Pack weights(0);
  for (std::size_t i = 0; i < in.count; i += Pack::size) {
    const auto residual = MetricResidual::of(Pack::load(in.values + i), Pack::load(in.model + i),
                                             Pack::load(in.cos_i + i), Pack::load(in.factors + i));
    const Pack weight = weight_at(in, i);
    const Pack s = (residual.value / scale) * (residual.value / scale);
    const LossValue<Pack> lossy = loss(s);
    const Pack weighted = weight * lossy.slope;
    residual.value.store(&out.residuals[i]);
    (weighted * residual.value * residual.slope).store(&out.scores[i]);
    (weight * lossy.influence * residual.slope * residual.slope).store(&out.curvatures[i]);
    square += weighted * residual.value * residual.value;
    weights += weighted;
  }
  sums.metric_square += square.sum();
  sums.metric_weight += weights.sum();
}

GONIO_FOR_EACH_CPU void multiply_columns(double* to, const double* a, const double* b,
                                         std::size_t count) {
  std::fill_n(to, count, 0.0);
  add_product(to, 1, a, b, count);
}

GONIO_FOR_EACH_CPU void add_products(double* to, double factor, const double* a, const double* b,
                                     std::size_t count) {
  add_product(to, factor, a, b, count);
}

/// to(a, b) += a'b for the columns up to the diagonal, all column_stride apart.
GONIO_FOR_EACH_CPU void add_inner_products(const double* a, const double* b, std::size_t columns,
                                           std::size_t count, double* to) {
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      to[i + j * columns] += inner_product(a + i * std::size_t(column_stride),
                                           b + j * std::size_t(column_stride), count);
    }
  }
}

/// sums(k, 0) and sums(k, 1) += the sums of the squares and of the fourth powers of column k.
GONIO_FOR_EACH_CPU void add_powers(const double* columns, std::size_t column_count,
                                   std::size_t count, double* squares, double* sums) {
  for (std::size_t k = 0; k < column_count; ++k) {
    const double* column = columns + k * std::size_t(column_stride);
    std::fill_n(squares, count, 0.0);
    add_product(squares, 1, column, column, count);
    sums[k] += inner_product(column, column, count);
    sums[k + column_count] += inner_product(squares, squares, count);
  }
}

struct State {
  ErrorSums errors;
  Eigen::MatrixXd score_products, curvature;
  Eigen::MatrixXd powers;  // [amplitude, second | fourth]
  std::size_t outlier_count = 0;
  std::vector<Outlier> outliers;
  double log_variance = 0;
  // Of a chunk:
  Eigen::MatrixXd columns, model_values, scores, gradients, weighted_gradients;
  RowColumns rows;
};

class Assessor {
 public:
  Assessor(const WeightedSamples& samples, const BatchModel& model, const ParameterValues& values,
           std::span<const Unknown> unknowns, std::span<const double> floors,
           const AssessmentOptions& options)
      : samples_(samples),
        model_(model),
        values_(values),
        coefficients_(model.coefficients(values.amplitudes)),
        unknowns_(unknowns),
        floors_(floors),
        options_(options),
        with_curvature_(options.scores && options.loss.loss != Loss::none) {
    for (Eigen::Index c = 0; c < values.amplitudes.cols(); ++c) {
      coefficient_jacobians_.push_back(model.coefficient_jacobian(values.amplitudes.col(c)));
    }
  }

  State make_state() const {
    const auto unknown_count = Eigen::Index(unknowns_.size());
    State state;
    state.columns.resize(column_stride, Eigen::Index(model_.column_count(true)));
    state.powers.setZero(Eigen::Index(model_.basis_size()), 2);
    state.model_values.resize(column_stride, values_.amplitudes.cols());
    if (options_.scores) {
      state.score_products.setZero(unknown_count, unknown_count);
      state.scores.resize(column_stride, unknown_count);
    }
    if (with_curvature_) {
      state.curvature.setZero(unknown_count, unknown_count);
      state.gradients.resize(column_stride, unknown_count);
      state.weighted_gradients.resize(column_stride, unknown_count);
    }
    return state;
  }

  void fold(const SampleChunk& chunk, State& state) const {
    const auto rows = Eigen::Index(chunk.padded_count());
    model_.evaluate(chunk.directions, values_.shape, options_.scores, state.columns);
    state.model_values.topRows(rows).noalias() =
        state.columns.topLeftCorner(rows, coefficients_.rows()) * coefficients_;
    // The padding holds directions, and so values.
    state.columns
        .block(Eigen::Index(chunk.directions.count), 0, rows - Eigen::Index(chunk.directions.count),
               coefficients_.rows())
        .setZero();
    add_powers(state.columns.data(), model_.basis_size(), std::size_t(rows),
               state.rows.residuals.data(), state.powers.data());
    if (options_.scores) state.scores.topRows(rows).setZero();
    for (Eigen::Index c = 0; c < chunk.values.cols(); ++c) {
      const ChannelColumns in = columns_of(chunk, samples_, c, state.model_values.col(c).data());
      add_errors(in, floors_[std::size_t(c)], state.errors);
      with_residual(samples_.metric(), [&](auto residual) {
        write_rows<decltype(residual)>(in, options_.loss, state.rows, state.errors);
      });
      if (options_.scores) add_scores(std::size_t(c), std::size_t(rows), state);
      if (with_curvature_) add_curvature(std::size_t(c), std::size_t(rows), state);
      if (std::isfinite(options_.outlier_threshold)) add_outliers(chunk, std::size_t(c), state);
      if (samples_.metric() == Metric::chi2) add_variances(chunk, c, state);
    }
    if (options_.scores) {
      add_inner_products(state.scores.data(), state.scores.data(), unknowns_.size(),
                         std::size_t(rows), state.score_products.data());
    }
  }

  /// Sorts the worst first, and leaves as many as are to be listed.
  void keep_largest(std::vector<Outlier>& outliers) const {
    // A total order: the largest of all are the same whatever order the parts come in.
    std::sort(outliers.begin(), outliers.end(), [](const Outlier& a, const Outlier& b) {
      return std::tuple(-std::abs(a.residual), a.sample, a.channel) <
             std::tuple(-std::abs(b.residual), b.sample, b.channel);
    });
    outliers.resize(std::min(outliers.size(), options_.most_listed));
  }

 private:
  /// Calls add(unknown, factor, column) for each summand of the gradient of the channel's model by
  /// the unknowns: factor * column.
  template <class Add>
  void for_gradient(std::size_t channel, const State& state, const Add& add) const {
    const auto column_stride_of = [&](std::size_t column) {
      return state.columns.col(Eigen::Index(column)).data();
    };
    for (std::size_t u = 0; u < unknowns_.size(); ++u) {
      const Unknown& unknown = unknowns_[u];
      if (!unknown.is_shape) {
        if (unknown.channel != channel) continue;
        const auto slopes = coefficient_jacobians_[channel].col(Eigen::Index(unknown.index));
        for (Eigen::Index b = 0; b < slopes.size(); ++b) {
          if (slopes[b] != 0) add(u, slopes[b], column_stride_of(std::size_t(b)));
        }
        continue;
      }
      for (std::size_t d = 0; d < model_.derivatives().size(); ++d) {
        const BatchModel::Derivative derivative = model_.derivatives()[d];
        if (derivative.shape != unknown.index) continue;
        add(u, coefficients_(Eigen::Index(derivative.basis), Eigen::Index(channel)),
            column_stride_of(model_.basis_size() + d));
      }
    }
  }

  void add_scores(std::size_t channel, std::size_t rows, State& state) const {
    for_gradient(channel, state, [&](std::size_t u, double factor, const double* column) {
      add_products(state.scores.col(Eigen::Index(u)).data(), factor, state.rows.scores.data(),
                   column, rows);
    });
  }

  void add_curvature(std::size_t channel, std::size_t rows, State& state) const {
    state.gradients.topRows(Eigen::Index(rows)).setZero();
    for_gradient(channel, state, [&](std::size_t u, double factor, const double* column) {
      state.gradients.col(Eigen::Index(u)).head(Eigen::Index(rows)) +=
          factor * Eigen::Map<const Eigen::VectorXd>(column, Eigen::Index(rows));
    });
    for (Eigen::Index u = 0; u < state.gradients.cols(); ++u) {
      multiply_columns(state.weighted_gradients.col(u).data(), state.gradients.col(u).data(),
                       state.rows.curvatures.data(), rows);
    }
    add_inner_products(state.gradients.data(), state.weighted_gradients.data(), unknowns_.size(),
                       rows, state.curvature.data());
  }

  void add_outliers(const SampleChunk& chunk, std::size_t channel, State& state) const {
    for (std::size_t r = 0; r < chunk.directions.count; ++r) {
      const double residual = state.rows.residuals[r];
      if (!(std::abs(residual) > options_.outlier_threshold)) continue;
      ++state.outlier_count;
      state.outliers.push_back({chunk.samples[r], channel, -residual});
    }
    if (state.outliers.size() / 4 > options_.most_listed) keep_largest(state.outliers);
  }

  void add_variances(const SampleChunk& chunk, Eigen::Index channel, State& state) const {
    for (std::size_t r = 0; r < chunk.directions.count; ++r) {
      const double factor = chunk.factors(Eigen::Index(r), channel);
      if (factor > 0) {
        state.log_variance += std::log(2 * std::numbers::pi) - 2 * std::log(factor);
      }
    }
  }

  const WeightedSamples& samples_;
  const BatchModel& model_;
  const ParameterValues& values_;
  Eigen::MatrixXd coefficients_;                        // [basis, channel]
  std::vector<Eigen::MatrixXd> coefficient_jacobians_;  // per channel, [basis, amplitude]
  std::span<const Unknown> unknowns_;
  std::span<const double> floors_;
  const AssessmentOptions& options_;
  bool with_curvature_;
};

/// What remains of a task.
struct Part {
  ErrorSums errors;
  Eigen::MatrixXd score_products, curvature, powers;
  std::size_t outlier_count;
  double log_variance;
};

}  // namespace

Assessment assess(const WeightedSamples& samples, const BatchModel& model,
                  const ParameterValues& values, std::span<const Unknown> unknowns,
                  std::span<const double> floors, const AssessmentOptions& options,
                  const PassOptions& passes) {
  const Assessor assessor(samples, model, values, unknowns, floors, options);
  Assessment result;
  std::mutex outliers_mutex;
  const std::vector<Part> parts = chunk_pass(
      samples, passes, [&] { return assessor.make_state(); },
      [&](const SampleChunk& chunk, State& state) { assessor.fold(chunk, state); },
      [&](const State& state) {
        const std::lock_guard lock(outliers_mutex);
        result.outliers.insert(result.outliers.end(), state.outliers.begin(), state.outliers.end());
        if (result.outliers.size() / 4 > options.most_listed)
          assessor.keep_largest(result.outliers);
        return Part{state.errors, state.score_products, state.curvature,
                    state.powers, state.outlier_count,  state.log_variance};
      });
  ErrorSums errors;
  result.score_products = parts.front().score_products;
  result.curvature = parts.front().curvature;
  Eigen::MatrixXd powers = parts.front().powers;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Part& part = parts[p];
    errors.add(part.errors);
    if (p > 0) {
      result.score_products += part.score_products;
      result.curvature += part.curvature;
      powers += part.powers;
    }
    result.outlier_count += part.outlier_count;
    result.log_variance += part.log_variance;
  }
  assessor.keep_largest(result.outliers);
  for (Eigen::MatrixXd* matrix : {&result.score_products, &result.curvature}) {
    const Eigen::MatrixXd whole = matrix->selfadjointView<Eigen::Lower>();
    *matrix = whole;
  }
  const auto root = [](double sum, double weight) {
    return weight > 0 ? std::sqrt(sum / weight) : 0;
  };
  for (std::size_t m = 0; m < error_names.size(); ++m) {
    result.errors.emplace_back(error_names[m], root(errors.squares[m], errors.weight));
  }
  result.metric_error = root(errors.metric_square, errors.metric_weight);
  result.seen_by = (powers.col(1).array() > 0)
                       .select(powers.col(0).array().square() / powers.col(1).array(), 0.0);
  result.weight = errors.weight;
  result.metric_weight = errors.metric_weight;
  result.values = samples.survey().used_values;
  return result;
}

}  // namespace gonio::fit
