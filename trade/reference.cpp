#include "trade/reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "table/file_error.h"
#include "trade/float_direction.h"
#include "trade/lobe_grid.h"

namespace gonio::trade {
namespace {

using Pair = brdf::DirectionPair<double>;

double degrees_of(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * (180 / std::numbers::pi);
}

/// For each channel of the material the table's of the same name.
std::vector<std::size_t> channels_in(const table::SampleTable& samples,
                                     const material::Material& material) {
  std::vector<std::size_t> columns;
  for (const std::string& channel : material.channels) {
    const auto found = std::find(samples.channels.begin(), samples.channels.end(), channel);
    if (found == samples.channels.end()) {
      throw table::FileError(
          fmt::format("{}: found the channels {}, expected '{}' among them, which the material "
                      "has: name the table that the material was fitted to",
                      samples.provenance.path, fmt::join(samples.channels, ", "), channel));
    }
    columns.push_back(std::size_t(found - samples.channels.begin()));
  }
  return columns;
}

/// The used samples of a table as the channels of a material have them.
class UsedSamples {
 public:
  UsedSamples(const material::Material& material, const table::SampleTable& samples,
              double max_theta_deg)
      : samples_(samples), columns_(channels_in(samples, material)) {
    const table::SampleFilter is_used(samples, max_theta_deg);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (is_used(i)) used_.push_back(i);
    }
    if (!used_.empty()) return;
    throw table::FileError(
        fmt::format("{}: found no usable sample with both polar angles up to {:g} deg, expected "
                    "at least one: check the table with gonio info",
                    samples.provenance.path, max_theta_deg));
  }

  std::size_t size() const { return used_.size(); }
  Pair pair(std::size_t k) const { return {samples_.wi[used_[k]], samples_.wo[used_[k]]}; }
  double value(std::size_t k, std::size_t channel) const {
    return samples_.values[columns_[channel]][used_[k]];
  }
  /// 0 where the value was not measured.
  double weight(std::size_t k, std::size_t channel) const {
    if (std::isnan(value(k, channel))) return 0;
    return samples_.has_weight() ? samples_.weight[used_[k]] : 1;
  }

 private:
  const table::SampleTable& samples_;
  std::vector<std::size_t> columns_;
  std::vector<std::size_t> used_;
};

Reference reference_at(const brdf::BoundModel& model, std::vector<Pair> pairs,
                       std::vector<double> weights, std::size_t samples) {
  for (Pair& pair : pairs) pair = in_double(in_float(pair));
  std::vector<double> f_r = reflectances(model, pairs);
  LobeGauge gauge(model, pairs);
  return {std::move(pairs), std::move(weights), model.channel_count(),
          std::move(f_r),   std::move(gauge),   samples};
}

/// Sums of squares and of weights, which give a weighted root mean square.
struct MeanSquare {
  double squares = 0;
  double weights = 0;

  void add(double value, double weight) {
    squares += value * value * weight;
    weights += weight;
  }
  double root() const { return weights > 0 ? std::sqrt(squares / weights) : 0; }
};

}  // namespace

Reference reference_on_grid(const brdf::BoundModel& model) {
  std::vector<Pair> pairs;
  std::vector<double> weights;
  for (const auto& [pair, weight] : lobe_grid(model)) {
    pairs.push_back(pair);
    weights.insert(weights.end(), model.channel_count(), weight);
  }
  return reference_at(model, std::move(pairs), std::move(weights), 0);
}

Reference reference_on_samples(const brdf::BoundModel& model, const material::Material& material,
                               const table::SampleTable& samples, double max_theta_deg) {
  const UsedSamples used(material, samples, max_theta_deg);
  const std::size_t channels = model.channel_count();
  std::vector<Pair> pairs;
  for (const WeightedPair& point : lobe_grid(model)) pairs.push_back(point.pair);
  std::vector<double> weights(pairs.size() * channels);
  for (std::size_t k = 0; k < used.size(); ++k) {
    pairs.push_back(used.pair(k));
    for (std::size_t c = 0; c < channels; ++c) weights.push_back(used.weight(k, c));
  }
  return reference_at(model, std::move(pairs), std::move(weights), used.size());
}

Reference thinned(const Reference& reference, std::size_t of_grid, std::size_t of_samples) {
  const std::size_t channels = reference.channels;
  Reference thin{{}, {}, channels, {}, reference.gauge, 0};
  const auto keep = [&](std::size_t i) {
    thin.pairs.push_back(reference.pairs[i]);
    for (std::size_t k = i * channels; k < (i + 1) * channels; ++k) {
      thin.weights.push_back(reference.weights[k]);
      thin.f_r.push_back(reference.f_r[k]);
    }
  };
  const auto keep_some = [&](std::size_t first, std::size_t last, std::size_t count) {
    const std::size_t step =
        std::max<std::size_t>(1, (last - first) / std::max<std::size_t>(1, count));
    for (std::size_t i = first; i < last; i += step) keep(i);
  };
  const std::size_t grid = reference.pairs.size() - reference.samples;
  keep_some(0, grid, of_grid);
  const auto brightest = std::max_element(reference.f_r.begin(), reference.f_r.end());
  keep(std::size_t(brightest - reference.f_r.begin()) / channels);
  const std::size_t kept = thin.pairs.size();
  keep_some(grid, reference.pairs.size(), of_samples);
  thin.samples = thin.pairs.size() - kept;
  return thin;
}

EvaluatorError error_of(const Reference& reference, std::span<const double> f_r) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EvaluatorError error;
  MeanSquare radiance;
  for (std::size_t k = 0; k < f_r.size(); ++k) {
    const Pair& pair = reference.pairs[k / reference.channels];
    const std::size_t channel = k % reference.channels;
    const double apart = std::isfinite(f_r[k]) ? std::abs(f_r[k] - reference.f_r[k]) : infinity;
    const double share = apart / reference.gauge.at(channel, reference.f_r[k]);
    if (share > error.largest) {
      error.largest = share;
      error.where = {degrees_of(pair.wi.z), degrees_of(pair.wo.z), channel};
    }
    if (reference.weights[k] > 0) radiance.add(apart * pair.wi.z, reference.weights[k]);
  }
  error.rms = radiance.root();
  return error;
}

double cosine_residual(const brdf::BoundModel& model, const material::Material& material,
                       const table::SampleTable& samples, double max_theta_deg) {
  const UsedSamples used(material, samples, max_theta_deg);
  std::vector<double> f_r(model.channel_count());
  MeanSquare residual;
  for (std::size_t k = 0; k < used.size(); ++k) {
    const Pair pair = used.pair(k);
    model.f_r(pair.wi, pair.wo, f_r);
    for (std::size_t c = 0; c < f_r.size(); ++c) {
      const double weight = used.weight(k, c);
      if (weight > 0) residual.add((used.value(k, c) - f_r[c]) * pair.wi.z, weight);
    }
  }
  return residual.root();
}

double radiance_rms(const Reference& reference, std::span<const double> f_r) {
  MeanSquare radiance;
  for (std::size_t k = 0; k < f_r.size(); ++k) {
    const double cos_i = reference.pairs[k / reference.channels].wi.z;
    radiance.add(f_r[k] * cos_i, reference.weights[k]);
  }
  return radiance.root();
}

}  // namespace gonio::trade
