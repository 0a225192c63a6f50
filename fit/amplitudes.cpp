#include "fit/amplitudes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/channel_amplitudes.h"
#include "fit/residual.h"

namespace gonio::fit {
namespace {

constexpr int most_iterations = 12;
constexpr int most_magnitude_iterations = 24;
constexpr int most_halvings = 4;

/// One channel's samples, in columns.
struct Channel {
  Eigen::MatrixXd basis;
  Eigen::ArrayXd values, cos_i, factors, weights;
};

Channel channel_of(const WeightedSamples& samples, std::span<const SampleChunk> chunks,
                   const std::vector<Eigen::MatrixXd>& bases, Eigen::Index c) {
  Eigen::Index rows = 0;
  for (const SampleChunk& chunk : chunks) rows += Eigen::Index(chunk.directions.count);
  Channel channel{Eigen::MatrixXd(rows, bases.front().cols()), Eigen::ArrayXd(rows),
                  Eigen::ArrayXd(rows), Eigen::ArrayXd(rows), Eigen::ArrayXd(rows)};
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < chunks.size(); ++k) {
    const SampleChunk& chunk = chunks[k];
    const auto count = Eigen::Index(chunk.directions.count);
    channel.basis.middleRows(first, count) = bases[k].topRows(count);
    channel.values.segment(first, count) = chunk.values.col(c).head(count);
    channel.factors.segment(first, count) = chunk.factors.col(samples.factor_column(c)).head(count);
    channel.cos_i.segment(first, count) =
        Eigen::Map<const Eigen::ArrayXd>(chunk.directions.wi_z.data(), count);
    channel.weights.segment(first, count) =
        Eigen::Map<const Eigen::ArrayXd>(chunk.weights.data(), count);
    first += count;
  }
  return channel;
}

struct Residuals {
  Eigen::ArrayXd value, slope;
};

Residuals residuals_of(const Channel& channel, const Eigen::ArrayXd& model, Metric metric) {
  Residuals out{Eigen::ArrayXd(model.size()), Eigen::ArrayXd(model.size())};
  with_residual(metric, [&](auto residual) {
    for (Eigen::Index i = 0; i < model.size(); ++i) {
      const Residual<double> r =
          decltype(residual)::of(channel.values[i], model[i], channel.cos_i[i], channel.factors[i]);
      out.value[i] = r.value;
      out.slope[i] = r.slope;
    }
  });
  return out;
}

double median_magnitude(const Eigen::ArrayXd& values) {
  Eigen::ArrayXd magnitudes = values.abs();
  const auto middle = magnitudes.begin() + magnitudes.size() / 2;
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return *middle;
}

/// The weights of squares that stand for the sum of magnitudes.
Eigen::ArrayXd magnitude_weights(const Channel& channel, const Eigen::ArrayXd& residuals) {
  const double least = 1e-3 * median_magnitude(residuals) + 1e-300;
  return channel.weights / residuals.abs().max(least);
}

/// A cube root is infinitely steep where nothing was seen.
Eigen::ArrayXd limited(const Eigen::ArrayXd& slopes) {
  return slopes.min(20 * median_magnitude(slopes));
}

/// The amplitudes of one channel, and their cost.
struct Solved {
  Eigen::VectorXd amplitudes;
  double cost;
};

class AmplitudeSolver {
 public:
  AmplitudeSolver(const Channel& channel, const BatchModel& model, Metric metric, Loss loss,
                  const Box& box, Eigen::Index c)
      : channel_(channel), model_(model), metric_(metric), loss_(loss), amplitudes_(box, c) {}

  /// All amplitudes, where the solution gives the free ones.
  Eigen::VectorXd all(const Eigen::VectorXd& free) const { return amplitudes_.all(free); }

  Solved solve() const { return loss_ == Loss::none ? least_squares() : least_magnitudes(); }

 private:
  Eigen::ArrayXd model_at(const Eigen::VectorXd& free) const {
    return (channel_.basis * model_.coefficients(amplitudes_.all(free))).array();
  }

  Solved at(const Eigen::VectorXd& free) const {
    const Eigen::ArrayXd residuals = residuals_of(channel_, model_at(free), metric_).value;
    if (loss_ == Loss::none) return {free, (channel_.weights * residuals.square()).sum()};
    // Magnitudes, but none beyond the data's own size counts for more: a single wild one would
    // drown the differences between shapes.
    const double size =
        median_magnitude(
            residuals_of(channel_, Eigen::ArrayXd::Zero(residuals.size()), metric_).value) +
        1e-300;
    return {free, (channel_.weights * residuals.abs() / (residuals.abs() + size)).sum()};
  }

  Solved least_squares() const {
    Solved best = at(linear_start());
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      const Solved next = improved(best);
      if (!(next.cost < (1 - 1e-6) * best.cost)) break;
      best = next;
    }
    return best;
  }

  /// Each round a wild value pulls less by as much as there are others.
  Solved least_magnitudes() const {
    Eigen::VectorXd free = linear_start();
    for (int iteration = 0; iteration < most_magnitude_iterations; ++iteration) {
      const Eigen::ArrayXd model = model_at(free);
      const Residuals residuals = residuals_of(channel_, model, metric_);
      const Eigen::VectorXd next =
          reweighted(model, residuals, magnitude_weights(channel_, residuals.value));
      const bool settled = (next - free).norm() <= 1e-4 * next.norm();
      free = next;
      if (settled) break;
    }
    return at(free);
  }

  /// Minimises sum of weight * slope^2 * (model - target)^2.
  Eigen::VectorXd weighted(const Eigen::ArrayXd& weights, const Eigen::ArrayXd& slopes,
                           const Eigen::ArrayXd& targets) const {
    const Eigen::ArrayXd rows = weights.sqrt() * slopes;
    const Eigen::MatrixXd basis = channel_.basis.array().colwise() * rows;
    return solve_amplitudes(model_, amplitudes_, basis, (rows * targets).matrix());
  }

  /// The metric taken for linear near the measured values.
  Eigen::VectorXd linear_start() const {
    const Residuals near_data = residuals_of(channel_, channel_.values, metric_);
    return weighted(channel_.weights, limited(near_data.slope), channel_.values);
  }

  /// The amplitudes that minimise the weighted squares near a model's values.
  Eigen::VectorXd reweighted(const Eigen::ArrayXd& model, const Residuals& residuals,
                             const Eigen::ArrayXd& weights) const {
    const Eigen::ArrayXd slopes = limited(residuals.slope);
    const Eigen::ArrayXd targets =
        (slopes > 0).select(model - residuals.value / slopes.max(1e-300), model);
    return weighted(weights, slopes, targets);
  }

  Solved improved(const Solved& now) const {
    const Eigen::ArrayXd model = model_at(now.amplitudes);
    Eigen::VectorXd free =
        reweighted(model, residuals_of(channel_, model, metric_), channel_.weights);
    Solved next = at(free);
    for (int halving = 0; halving < most_halvings && !(next.cost < now.cost); ++halving) {
      free = (free + now.amplitudes) / 2;
      next = at(free);
    }
    return next;
  }

  const Channel& channel_;
  const BatchModel& model_;
  Metric metric_;
  Loss loss_;
  FreeAmplitudes amplitudes_;
};

}  // namespace

ShapeCost best_amplitudes(const WeightedSamples& samples, std::span<const SampleChunk> chunks,
                          const BatchModel& model, const Box& box, std::span<const double> shape,
                          Loss loss) {
  std::vector<Eigen::MatrixXd> bases;
  for (const SampleChunk& chunk : chunks) {
    bases.emplace_back(column_stride, Eigen::Index(model.basis_size()));
    model.evaluate(chunk.directions, shape, false, bases.back());
  }
  ShapeCost result{
      Eigen::MatrixXd(Eigen::Index(model.amplitude_count()), Eigen::Index(samples.channel_count())),
      0};
  for (Eigen::Index c = 0; c < result.amplitudes.cols(); ++c) {
    const Channel channel = channel_of(samples, chunks, bases, c);
    const AmplitudeSolver solver(channel, model, samples.metric(), loss, box, c);
    const Solved solved = solver.solve();
    result.amplitudes.col(c) = solver.all(solved.amplitudes);
    result.cost += solved.cost;
  }
  return result;
}

}  // namespace gonio::fit
