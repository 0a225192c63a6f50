#include "fit/robust_scale.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "fit/median.h"
#include "fit/residual.h"

namespace gonio::fit {
namespace {

using brdf::Pack;

/// The standard deviation of the normal distribution over its median magnitude.
constexpr double deviation_over_median = 1.4826022185056018;
/// What two rounds leave of the bracket 0.8 .. 1.25: 0.45 / 2048^2, of a median of 0.8 or more.
constexpr double median_tolerance = 1.5e-7;
/// Shares of the largest weight that weights are counted in.
constexpr double weight_steps = 65536;

/// Writes the magnitudes of the residuals.
template <class MetricResidual>
GONIO_FOR_EACH_CPU void write_magnitudes(const ChannelColumns& in, double* magnitudes) {
  for (std::size_t i = 0; i < in.count; i += Pack::size) {
    abs(MetricResidual::of(Pack::load(in.values + i), Pack::load(in.model + i),
                           Pack::load(in.cos_i + i), Pack::load(in.factors + i))
            .value)
        .store(magnitudes + i);
  }
}

struct State {
  MedianSearch::Counts counts;
  Eigen::MatrixXd basis;
  Eigen::VectorXd magnitudes;
};

/// Calls function(channel, magnitudes) with the magnitudes of the residuals of each channel, at the
/// given f_r: [row, channel].
template <class Function>
void for_magnitudes(const SampleChunk& chunk, const WeightedSamples& samples,
                    const Eigen::MatrixXd& f_r, Eigen::VectorXd& magnitudes,
                    const Function& function) {
  for (Eigen::Index c = 0; c < f_r.cols(); ++c) {
    const ChannelColumns in = columns_of(chunk, samples, c, f_r.col(c).data());
    with_residual(samples.metric(), [&](auto residual) {
      write_magnitudes<decltype(residual)>(in, magnitudes.data());
    });
    function(c, magnitudes);
  }
}

/// Adds the magnitudes of the values that were measured; `times` is empty where there are no
/// weights.
void add_measured(const double* factors, std::size_t count, std::vector<std::uint64_t> times,
                  Eigen::VectorXd& magnitudes, MedianSearch::Counts& counts) {
  std::size_t measured = 0;
  for (std::size_t r = 0; r < count; ++r) {
    magnitudes[Eigen::Index(measured)] = magnitudes[Eigen::Index(r)];
    if (!times.empty()) times[measured] = times[r];
    measured += std::size_t(factors[r] > 0);
  }
  const std::span<const double> kept(magnitudes.data(), measured);
  if (times.empty()) {
    counts.add(kept);
  } else {
    counts.add(kept, std::span(times).first(measured));
  }
}

void count_chunk(const SampleChunk& chunk, const WeightedSamples& samples, const BatchModel& model,
                 const ParameterValues& values, State& state) {
  model.evaluate(chunk.directions, values.shape, false, state.basis);
  const Eigen::MatrixXd f_r = state.basis.topRows(Eigen::Index(chunk.padded_count())) *
                              model.coefficients(values.amplitudes);
  std::vector<std::uint64_t> times;
  if (samples.has_weight()) {
    const double weight_scale = weight_steps / samples.survey().largest_weight;
    for (std::size_t r = 0; r < chunk.directions.count; ++r) {
      times.push_back(std::max<std::uint64_t>(std::uint64_t(chunk.weights[r] * weight_scale), 1));
    }
  }
  for_magnitudes(chunk, samples, f_r, state.magnitudes,
                 [&](Eigen::Index c, Eigen::VectorXd& magnitudes) {
                   const double* factors = chunk.factors.col(samples.factor_column(c)).data();
                   add_measured(factors, chunk.directions.count, times, magnitudes, state.counts);
                 });
}

/// The median magnitude of the residuals, as well as `search` finds it.
double median_residual(const WeightedSamples& samples, const BatchModel& model,
                       const ParameterValues& values, MedianSearch search,
                       const PassOptions& passes) {
  std::mutex mutex;
  while (!search.done()) {
    chunk_pass(
        samples, passes,
        [&] {
          return State{search.counts(),
                       Eigen::MatrixXd(column_stride, Eigen::Index(model.basis_size())),
                       Eigen::VectorXd(column_stride)};
        },
        [&](const SampleChunk& chunk, State& state) {
          count_chunk(chunk, samples, model, values, state);
        },
        [&](const State& state) {
          const std::lock_guard lock(mutex);
          search.add(state.counts);
          return 0;
        });
    search.end_round();
  }
  return search.value();
}

}  // namespace

double least_deviation(const WeightedSamples& samples, const BatchModel& model,
                       const PassOptions& passes) {
  const ParameterValues nothing{std::vector<double>(model.shape_count(), 1),
                                Eigen::MatrixXd::Zero(Eigen::Index(model.amplitude_count()),
                                                      Eigen::Index(samples.channel_count()))};
  // Its size is enough.
  const double least =
      1e-10 * median_residual(samples, model, nothing, MedianSearch(0, 0, 0.9), passes);
  return least > 0 ? least : 1;
}

double robust_deviation(const WeightedSamples& samples, const BatchModel& model,
                        const ParameterValues& values, double near, double least,
                        const PassOptions& passes) {
  const double median_near = near / deviation_over_median;
  const MedianSearch search(0.8 * median_near, 1.25 * median_near, median_tolerance,
                            least / deviation_over_median);
  return std::max(deviation_over_median * median_residual(samples, model, values, search, passes),
                  least);
}

}  // namespace gonio::fit
