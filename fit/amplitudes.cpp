#include "fit/amplitudes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/bounded_least_squares.h"
#include "fit/residual.h"

namespace gonio::fit {
namespace {

constexpr int most_iterations = 12;
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

double cost_of_residuals(const Channel& channel, const Eigen::ArrayXd& residuals, Loss loss) {
  return loss == Loss::none ? (channel.weights * residuals.square()).sum()
                            : (channel.weights * residuals.abs()).sum();
}

/// The weights of squares that stand for the cost near the residuals.
Eigen::ArrayXd square_weights(const Channel& channel, const Eigen::ArrayXd& residuals, Loss loss) {
  if (loss == Loss::none) return channel.weights;
  const double least = 1e-3 * residuals.abs().mean() + 1e-300;
  return channel.weights / residuals.abs().max(least);
}

Eigen::ArrayXd limited(Eigen::ArrayXd slopes) {
  Eigen::ArrayXd sorted = slopes;
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  // A cube root is infinitely steep where nothing was seen.
  return slopes.min(20 * sorted[sorted.size() / 2]);
}

/// The amplitudes of one channel, and their cost.
struct Solved {
  Eigen::VectorXd amplitudes;
  double cost;
};

class AmplitudeSolver {
 public:
  AmplitudeSolver(const Channel& channel, Metric metric, Loss loss, const Box& box, Eigen::Index c)
      : channel_(channel),
        metric_(metric),
        loss_(loss),
        space_(box.amplitudes),
        lower_(box.amplitude_lower(space_.free, c)),
        upper_(box.amplitude_upper(space_.free, c)) {}

  Solved solve() const {
    Solved best = at(linear_start());
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      const Solved next = improved(best);
      if (!(next.cost < (1 - 1e-6) * best.cost)) break;
      best = next;
    }
    return best;
  }

 private:
  Eigen::ArrayXd model_at(const Eigen::VectorXd& free) const {
    return (channel_.basis * (space_.offset + space_.map * free)).array();
  }

  Solved at(const Eigen::VectorXd& free) const {
    return {free, cost_of_residuals(channel_, residuals_of(channel_, model_at(free), metric_).value,
                                    loss_)};
  }

  /// Minimises sum of weight * slope^2 * (model - target)^2.
  Eigen::VectorXd weighted(const Eigen::ArrayXd& weights, const Eigen::ArrayXd& slopes,
                           const Eigen::ArrayXd& targets) const {
    const Eigen::ArrayXd rows = weights.sqrt() * slopes;
    const Eigen::MatrixXd matrix = (channel_.basis * space_.map).array().colwise() * rows;
    const Eigen::VectorXd rhs = rows * (targets - (channel_.basis * space_.offset).array());
    return bounded_least_squares(matrix, rhs, lower_, upper_);
  }

  /// The metric taken for linear near the measured values.
  Eigen::VectorXd linear_start() const {
    const Residuals near_data = residuals_of(channel_, channel_.values, metric_);
    return weighted(channel_.weights, limited(near_data.slope), channel_.values);
  }

  Solved improved(const Solved& now) const {
    const Eigen::ArrayXd model = model_at(now.amplitudes);
    const Residuals residuals = residuals_of(channel_, model, metric_);
    const Eigen::ArrayXd slopes = limited(residuals.slope);
    const Eigen::ArrayXd targets =
        (slopes > 0).select(model - residuals.value / slopes.max(1e-300), model);
    Eigen::VectorXd free =
        weighted(square_weights(channel_, residuals.value, loss_), slopes, targets);
    Solved next = at(free);
    for (int halving = 0; halving < most_halvings && !(next.cost < now.cost); ++halving) {
      free = (free + now.amplitudes) / 2;
      next = at(free);
    }
    return next;
  }

  const Channel& channel_;
  Metric metric_;
  Loss loss_;
  const AmplitudeSpace& space_;
  Eigen::VectorXd lower_, upper_;
};

}  // namespace

ShapeCost best_amplitudes(const WeightedSamples& samples, std::span<const SampleChunk> chunks,
                          const BatchModel& model, const Box& box, std::span<const double> shape,
                          Loss loss) {
  std::vector<Eigen::MatrixXd> bases;
  for (const SampleChunk& chunk : chunks) {
    bases.emplace_back(column_stride, Eigen::Index(model.amplitude_count()));
    model.evaluate(chunk.directions, shape, false, bases.back());
  }
  ShapeCost result{
      Eigen::MatrixXd(Eigen::Index(model.amplitude_count()), Eigen::Index(samples.channel_count())),
      0};
  for (Eigen::Index c = 0; c < result.amplitudes.cols(); ++c) {
    const Channel channel = channel_of(samples, chunks, bases, c);
    const Solved solved = AmplitudeSolver(channel, samples.metric(), loss, box, c).solve();
    result.amplitudes.col(c) = box.amplitudes.offset + box.amplitudes.map * solved.amplitudes;
    result.cost += solved.cost;
  }
  return result;
}

}  // namespace gonio::fit
