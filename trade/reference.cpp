#include "trade/reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "brdf/float_direction.h"
#include "table/file_error.h"
#include "trade/lobe_grid.h"
#include "trade/mean_square.h"
#include "trade/texel_directions.h"

namespace gonio::trade {
namespace {

using Pair = brdf::DirectionPair<double>;

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

/// The pairs in float and back in double, into two lists: written over themselves, g++ 12.2 leaves
/// some of them in double.
void set_pairs(Reference& reference, const std::vector<Pair>& pairs) {
  reference.pairs_in_float.reserve(pairs.size());
  for (const Pair& pair : pairs) reference.pairs_in_float.push_back(brdf::in_float(pair));
  reference.pairs.reserve(pairs.size());
  for (const auto& pair : reference.pairs_in_float)
    reference.pairs.push_back(brdf::in_double(pair));
}

Reference reference_at(const brdf::BoundModel& model, const std::vector<Pair>& pairs,
                       std::vector<double> weights, const LobeGauge& gauge, std::size_t samples) {
  Reference reference{{}, {}, std::move(weights), model.channel_count(), {}, gauge, samples};
  set_pairs(reference, pairs);
  reference.f_r = reflectances(model, reference.pairs);
  return reference;
}

}  // namespace

Reference reference_on_grid(const brdf::BoundModel& model) {
  std::vector<Pair> pairs;
  std::vector<double> weights;
  for (const auto& [pair, weight] : lobe_grid(model)) {
    pairs.push_back(pair);
    weights.insert(weights.end(), model.channel_count(), weight);
  }
  return reference_at(model, pairs, std::move(weights), LobeGauge(model, pairs), 0);
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
  return reference_at(model, pairs, std::move(weights), LobeGauge(model, pairs), used.size());
}

Reference reference_at_texels(const brdf::BoundModel& model, const lut::Layout& layout,
                              const LobeGauge& gauge, std::size_t every) {
  const std::vector<Pair> pairs = texel_directions(model, layout, every);
  return reference_at(model, pairs, std::vector<double>(pairs.size() * model.channel_count()),
                      gauge, 0);
}

Reference joined(Reference first, const Reference& second) {
  const auto append = [](auto& list, const auto& more) {
    list.insert(list.end(), more.begin(), more.end());
  };
  append(first.pairs_in_float, second.pairs_in_float);
  append(first.pairs, second.pairs);
  append(first.weights, second.weights);
  append(first.f_r, second.f_r);
  first.gauge = second.gauge;
  first.samples = second.samples;
  return first;
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
