#include "trade/lobe_gauge.h"

#include <algorithm>
#include <array>

#include "brdf/lobe_directions.h"

namespace gonio::trade {
namespace {

using Pair = brdf::DirectionPair<double>;

/// A lobe below this share of the channel's f_r is no gauge: the rounding of the rest would be.
constexpr double least_share_of_f_r = 1e-3;

/// Which basis functions are the lobe's.
std::vector<bool> lobe_parts(const brdf::Model& model) {
  std::vector<bool> parts;
  for (const std::size_t t : model.basis_terms()) {
    const bool is_diffuse = model.terms()[t]->description.kind == brdf::TermKind::diffuse;
    parts.push_back(!is_diffuse || model.terms().size() == 1);
  }
  return parts;
}

bool within_60_degrees(const Pair& pair) { return pair.wi.z >= 0.5 && pair.wo.z >= 0.5; }

/// Lights up to 60 degrees, and viewers at their mirror directions and about them.
std::vector<Pair> pairs_that_show_the_lobe() {
  constexpr brdf::LobeResolution coarse{
      .rings_per_e = 1, .rings_per_radian = 10, .azimuths = 8, .narrowest = 1e-5};
  std::vector<Pair> pairs;
  for (const double theta_deg : {0., 15., 30., 45., 60.}) {
    for (const double phi_deg : {0., 45., 90.}) {
      brdf::Direction<double> wi = brdf::direction_from_degrees(theta_deg, phi_deg);
      wi.z = std::max(wi.z, 0.5);  // 60 degrees are among them, whatever the cosine's rounding
      for (const auto& wo : brdf::lobe_directions(wi, coarse)) pairs.push_back({wi, wo.direction});
    }
  }
  return pairs;
}

void raise(std::vector<double>& largest, std::span<const double> values) {
  for (std::size_t c = 0; c < values.size(); ++c) largest[c] = std::max(largest[c], values[c]);
}

}  // namespace

std::vector<double> reflectances(const brdf::BoundModel& model, std::span<const Pair> pairs) {
  const std::size_t channels = model.channel_count();
  std::vector<double> f_r(pairs.size() * channels);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    model.f_r(pairs[i].wi, pairs[i].wo, std::span(f_r).subspan(i * channels, channels));
  }
  return f_r;
}

LobeGauge::LobeGauge(const brdf::BoundModel& model, std::span<const Pair> pairs)
    : lobe_peaks_(model.channel_count()), f_r_peaks_(model.channel_count()) {
  const std::vector<bool> in_lobe = lobe_parts(model.model());
  std::array<double, brdf::most_basis_functions> basis{};
  std::vector<double> lobe(model.channel_count());
  std::vector<double> f_r(model.channel_count());
  const auto look_at = [&](const Pair& pair) {
    if (!within_60_degrees(pair)) return;
    model.f_r(pair.wi, pair.wo, f_r);
    raise(f_r_peaks_, f_r);
    model.model().basis(model.shape(), pair.wi, pair.wo, basis);
    for (std::size_t c = 0; c < lobe.size(); ++c) {
      lobe[c] = 0;
      for (std::size_t b = 0; b < in_lobe.size(); ++b) {
        if (in_lobe[b]) lobe[c] += model.coefficients(c)[b] * basis[b];
      }
    }
    raise(lobe_peaks_, lobe);
  };
  std::for_each(pairs.begin(), pairs.end(), look_at);
  const std::vector<Pair> lobes = pairs_that_show_the_lobe();
  std::for_each(lobes.begin(), lobes.end(), look_at);
  for (std::size_t c = 0; c < lobe_peaks_.size(); ++c) {
    if (!(lobe_peaks_[c] > 0)) lobe_peaks_[c] = f_r_peaks_[c] > 0 ? f_r_peaks_[c] : 1;
    lobe_peaks_[c] = std::max(lobe_peaks_[c], least_share_of_f_r * f_r_peaks_[c]);
  }
}

double LobeGauge::at(std::size_t channel, double f_r) const {
  const double peak = lobe_peaks_[channel];
  return f_r > f_r_peaks_[channel] ? std::max(f_r, peak) : peak;
}

}  // namespace gonio::trade
