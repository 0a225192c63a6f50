#include "fit/errors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fit/chunk_pass.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {
namespace {

constexpr std::array<std::string_view, 5> metric_names{"l2", "cosine-l2", "log", "cube-root",
                                                       "relative"};

/// The (lower) median of a channel's magnitudes that are not 0, over the used samples, exactly and
/// in constant memory; 0 if there is none. A clamped instrument may read 0 in most places. The bits
/// of non-negative doubles are ordered like the numbers, so that 16 bits a pass narrow it down.
double median_magnitude(const std::vector<double>& channel, const table::SampleFilter& filter) {
  constexpr int digit_bits = 16;
  std::uint64_t prefix = 0;
  std::uint64_t rank = 0;
  for (int shift = 64 - digit_bits; shift >= 0; shift -= digit_bits) {
    const bool first = shift == 64 - digit_bits;
    const std::uint64_t prefix_mask = first ? 0 : ~std::uint64_t(0) << (shift + digit_bits);
    std::vector<std::uint64_t> histogram(std::size_t(1) << digit_bits);
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < channel.size(); ++i) {
      if (std::isnan(channel[i]) || channel[i] == 0 || !filter(i)) continue;
      const auto bits = std::bit_cast<std::uint64_t>(std::abs(channel[i]));
      if ((bits & prefix_mask) != prefix) continue;
      ++histogram[std::size_t(bits >> shift) & (histogram.size() - 1)];
      ++total;
    }
    if (total == 0) return 0;
    if (first) rank = (total - 1) / 2;
    std::size_t digit = 0;
    while (rank >= histogram[digit]) rank -= histogram[digit++];
    prefix |= std::uint64_t(digit) << shift;
  }
  return std::bit_cast<double>(prefix);
}

struct Sums {
  std::array<double, metric_names.size()> squares{};
  double weight = 0;

  void add(double weight_of_value, double value, double model, double cos_i, double floor) {
    const double seen = std::max(0.0, value * cos_i);
    const double expected = std::max(0.0, model * cos_i);
    const std::array<double, metric_names.size()> residuals{
        value - model, (value - model) * cos_i, std::log((1 + seen) / (1 + expected)),
        std::cbrt(seen) - std::cbrt(expected), (value - model) / std::max(std::abs(value), floor)};
    for (std::size_t m = 0; m < residuals.size(); ++m) {
      squares[m] += weight_of_value * residuals[m] * residuals[m];
    }
    weight += weight_of_value;
  }

  void add(const Sums& other) {
    for (std::size_t m = 0; m < squares.size(); ++m) squares[m] += other.squares[m];
    weight += other.weight;
  }
};

Sums sums_of_chunk(const SampleChunk& chunk, const Eigen::MatrixXd& model_values, bool shared,
                   const std::vector<double>& floors) {
  Sums sums;
  for (Eigen::Index c = 0; c < model_values.cols(); ++c) {
    for (std::size_t r = 0; r < chunk.directions.count; ++r) {
      const auto row = Eigen::Index(r);
      const double factor = chunk.factors(row, shared ? 0 : c);
      if (factor == 0) continue;
      sums.add(factor * factor, chunk.values(row, c), model_values(row, c),
               chunk.directions.wi_z[r], floors[std::size_t(c)]);
    }
  }
  return sums;
}

}  // namespace

ErrorList errors_of(const table::SampleTable& table, double max_theta_deg, const BatchModel& model,
                    const ParameterValues& values, const PassOptions& passes) {
  Options plain;
  plain.metric = Metric::l2;
  plain.max_theta_deg = max_theta_deg;
  const WeightedSamples samples(table, model, plain);

  std::vector<double> floors(table.channels.size());
  table::parallel_for(floors.size(), passes.threads, [&](std::size_t c) {
    const double median = median_magnitude(table.values[c], samples.filter());
    // A channel that is 0 everywhere has no relative error.
    floors[c] = median > 0 ? 0.01 * median : std::numeric_limits<double>::infinity();
  });

  struct State {
    Sums sums;
    Eigen::MatrixXd basis;
  };
  const std::vector<State> parts = chunk_pass(
      samples, passes,
      [&] {
        return State{{}, Eigen::MatrixXd(chunk_rows, Eigen::Index(model.amplitude_count()))};
      },
      [&](const SampleChunk& chunk, State& state) {
        model.evaluate(chunk.directions, values.shape, false, state.basis);
        const Eigen::MatrixXd model_values =
            state.basis.topRows(Eigen::Index(chunk.directions.count)) * values.amplitudes;
        state.sums.add(sums_of_chunk(chunk, model_values, samples.shared_factors(), floors));
      });
  Sums total;
  for (const State& part : parts) total.add(part.sums);

  ErrorList errors;
  for (std::size_t m = 0; m < metric_names.size(); ++m) {
    errors.emplace_back(metric_names[m],
                        total.weight > 0 ? std::sqrt(total.squares[m] / total.weight) : 0);
  }
  return errors;
}

}  // namespace gonio::fit
