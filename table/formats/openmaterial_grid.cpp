#include "table/formats/openmaterial_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "table/solid_angle.h"

namespace gonio::table {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double same_zenith = 1e-6;
constexpr double same_azimuth = 1e-5;

double zenith_of(const brdf::Direction<double>& d) { return std::atan2(std::hypot(d.x, d.y), d.z); }

/// From 0 to 2 pi; 0 where one of the directions is the normal.
double relative_azimuth(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo) {
  const double phi = std::atan2(wi.x * wo.y - wi.y * wo.x, wi.x * wo.x + wi.y * wo.y);
  return phi < 0 ? phi + 2 * pi : phi;
}

bool is_pole(double theta) { return theta <= same_zenith; }

}  // namespace

NestedGrid::NestedGrid(std::span<const RelativeAngles> angles, std::vector<std::size_t> samples)
    : samples_(std::move(samples)) {
  const auto key = [&](std::size_t sample) {
    const RelativeAngles& a = angles[sample];
    return std::tuple(a.theta_i, a.theta_o, a.phi);
  };
  std::sort(samples_.begin(), samples_.end(),
            [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  phi_.reserve(samples_.size());
  std::vector<std::size_t> ring_ends;
  for (const std::size_t sample : samples_) {
    const RelativeAngles& a = angles[sample];
    const bool is_new_slice = theta_i_.empty() || theta_i_.back() != a.theta_i;
    if (is_new_slice || theta_o_.back() != a.theta_o) {
      if (!phi_.empty()) ring_ends.push_back(phi_.size());
      if (is_new_slice) {
        theta_i_.push_back(a.theta_i);
        first_ring_.push_back(theta_o_.size());
      }
      theta_o_.push_back(a.theta_o);
    }
    phi_.push_back(a.phi);
  }
  ring_ends.push_back(phi_.size());
  first_ring_.push_back(theta_o_.size());
  std::size_t first = 0;
  for (const std::size_t end : ring_ends) {
    rings_.push_back(ring(first, end));
    first = end;
  }
}

NestedGrid::Ring NestedGrid::ring(std::size_t first, std::size_t last) const {
  constexpr double widest = 1.5;  // of the widest step within
  const double turn = 2 * pi;
  double step = 0;
  for (std::size_t i = first + 1; i < last; ++i) step = std::max(step, phi_[i] - phi_[i - 1]);
  const double closing = phi_[first] + turn - phi_[last - 1];
  const bool is_mirrored = phi_[last - 1] <= pi + same_azimuth;
  return {.first = first,
          .last = last,
          .is_mirrored = is_mirrored,
          .is_closed = !is_mirrored && closing <= widest * step + same_azimuth};
}

NestedGrid::Shares NestedGrid::shares(std::span<const double> nodes, double at, double tolerance) {
  if (at < nodes.front() - tolerance || at > nodes.back() + tolerance) return {};
  const auto above = std::upper_bound(nodes.begin(), nodes.end(), at);
  const auto second = static_cast<std::size_t>(above - nodes.begin());
  if (second == 0) return {.parts = {{{0, 1}, {0, 0}}}, .count = 1};
  if (second == nodes.size() || nodes[second - 1] == at) {
    return {.parts = {{{second - 1, 1}, {0, 0}}}, .count = 1};
  }
  const double share = (at - nodes[second - 1]) / (nodes[second] - nodes[second - 1]);
  return {.parts = {{{second - 1, 1 - share}, {second, share}}}, .count = 2};
}

NestedGrid::Shares NestedGrid::azimuth_shares(std::size_t index, bool is_any_azimuth,
                                              double phi) const {
  const Ring& ring = rings_[index];
  const std::span<const double> nodes = azimuths(ring);
  if (nodes.size() == 1 && is_any_azimuth) return {.parts = {{{0, 1}, {0, 0}}}, .count = 1};
  if (ring.is_mirrored) return shares(nodes, std::min(phi, 2 * pi - phi), same_azimuth);
  if (!ring.is_closed || (phi >= nodes.front() && phi <= nodes.back())) {
    return shares(nodes, phi, same_azimuth);
  }
  const double beyond = phi < nodes.front() ? phi + 2 * pi : phi;
  const double gap = nodes.front() + 2 * pi - nodes.back();
  const double share = gap > 0 ? std::clamp((beyond - nodes.back()) / gap, 0.0, 1.0) : 0;
  return {.parts = {{{nodes.size() - 1, 1 - share}, {0, share}}}, .count = 2};
}

GridNodes NestedGrid::nodes_for(const brdf::Direction<double>& wi,
                                const brdf::Direction<double>& wo) const {
  const double theta_o = zenith_of(wo);
  const double phi = relative_azimuth(wi, wo);
  GridNodes found;
  const Shares incidences = shares(theta_i_, zenith_of(wi), same_zenith);
  for (std::size_t i = 0; i < incidences.count; ++i) {
    const auto [slice, slice_share] = incidences.parts[i];
    const std::size_t first = first_ring_[slice];
    const auto exits = std::span(theta_o_).subspan(first, first_ring_[slice + 1] - first);
    const Shares zeniths = shares(exits, theta_o, same_zenith);
    if (zeniths.count == 0) return {};
    for (std::size_t j = 0; j < zeniths.count; ++j) {
      const auto [exit, exit_share] = zeniths.parts[j];
      const bool is_any_azimuth = is_pole(exits[exit]) || is_pole(theta_i_[slice]);
      const Shares around = azimuth_shares(first + exit, is_any_azimuth, phi);
      if (around.count == 0) return {};
      for (std::size_t k = 0; k < around.count; ++k) {
        const auto [node, share] = around.parts[k];
        found.nodes[found.count++] = {samples_[rings_[first + exit].first + node],
                                      slice_share * exit_share * share};
      }
    }
  }
  return found;
}

// Solid angles -------------------------------------------------------------------------------

/// Where a ring stands for both sides, its outer cells end in the plane of incidence: the other
/// side begins there.
std::vector<double> NestedGrid::azimuth_widths(const Ring& ring) const {
  const std::span<const double> phi = azimuths(ring);
  std::vector<double> widths = azimuth_measures(phi);
  if (!ring.is_mirrored || widths.size() < 2) return widths;
  const double first_reach = (phi[1] - phi[0]) / 2;
  const double last_reach = (phi.back() - phi[phi.size() - 2]) / 2;
  widths.front() -= std::clamp(first_reach - phi.front(), 0.0, first_reach);
  widths.back() -= std::clamp(phi.back() + last_reach - pi, 0.0, last_reach);
  return widths;
}

/// Of each ring of an incident zenith. A single azimuth, as at the pole, stands for as much as
/// those of another ring together.
std::vector<std::vector<double>> NestedGrid::slice_widths(std::size_t slice) const {
  std::vector<std::vector<double>> widths;
  double largest = 0;
  for (std::size_t r = first_ring_[slice]; r < first_ring_[slice + 1]; ++r) {
    widths.push_back(azimuth_widths(rings_[r]));
    if (widths.back().size() < 2) continue;
    largest = std::max(largest, std::accumulate(widths.back().begin(), widths.back().end(), 0.0));
  }
  for (std::vector<double>& ring : widths) {
    if (ring.size() == 1 && largest > 0) ring.front() = largest;
  }
  return widths;
}

/// Whether away from the pole exit zeniths mostly have several azimuths, or all the same one.
bool NestedGrid::is_exit_grid(std::size_t slice) const {
  std::size_t several = 0;
  std::vector<double> single;
  for (std::size_t r = first_ring_[slice]; r < first_ring_[slice + 1]; ++r) {
    if (is_pole(theta_o_[r])) continue;
    if (rings_[r].last - rings_[r].first > 1) {
      ++several;
    } else {
      single.push_back(phi_[rings_[r].first]);
    }
  }
  if (several > 0 || single.empty()) return several >= single.size();
  const auto [least, largest] = std::minmax_element(single.begin(), single.end());
  return *largest - *least <= same_azimuth;
}

/// Single exit directions make a grid of incident zeniths where their azimuth is the same for all.
bool NestedGrid::has_exit_grids() const {
  double azimuth = -1;
  for (std::size_t slice = 0; slice < theta_i_.size(); ++slice) {
    if (!is_exit_grid(slice)) return false;
    const Ring& first = rings_[first_ring_[slice]];
    const bool is_alone = first_ring_[slice + 1] - first_ring_[slice] == 1 &&
                          first.last - first.first == 1 && !is_pole(theta_o_[first_ring_[slice]]);
    if (!is_alone || is_pole(theta_i_[slice])) continue;
    if (azimuth >= 0 && std::abs(phi_[first.first] - azimuth) > same_azimuth) return false;
    azimuth = phi_[first.first];
  }
  return true;
}

std::vector<double> NestedGrid::solid_angles(std::size_t count) const {
  if (!has_exit_grids()) return {};
  std::vector<double> weights(count, 0.0);
  const std::vector<double> incident = zenith_measures(theta_i_, pi / 2);
  for (std::size_t slice = 0; slice < theta_i_.size(); ++slice) {
    const std::size_t first = first_ring_[slice];
    const auto exits = std::span(theta_o_).subspan(first, first_ring_[slice + 1] - first);
    const std::vector<double> zeniths = zenith_measures(exits, pi / 2);
    const std::vector<std::vector<double>> widths = slice_widths(slice);
    for (std::size_t r = 0; r < exits.size(); ++r) {
      for (std::size_t k = 0; k < widths[r].size(); ++k) {
        weights[samples_[rings_[first + r].first + k]] =
            incident[slice] * zeniths[r] * widths[r][k];
      }
    }
  }
  return weights;
}

}  // namespace gonio::table
