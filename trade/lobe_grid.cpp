#include "trade/lobe_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "brdf/lobe_directions.h"
#include "material/comparison.h"

namespace gonio::trade {
namespace {

using Direction = brdf::Direction<double>;
using std::numbers::pi;

/// Beyond it brdf::lobe_directions begins to miss a lobe (material/comparison.h).
constexpr double largest_shown_stretch = 6;
/// Of the slopes, in units of alpha: where the lobe is exp(-16) of its peak.
constexpr double lobe_end = 4;

/// A Ward lobe's axes: roughness along each, and the tangent's azimuth.
struct StretchedLobe {
  double alpha_x, alpha_y;
  double tangent;

  /// How far out in the lobe a half vector is, in units of alpha.
  double radius_of(const Direction& h) const {
    const double x = std::cos(tangent) * h.x + std::sin(tangent) * h.y;
    const double y = std::cos(tangent) * h.y - std::sin(tangent) * h.x;
    return std::hypot(x / alpha_x, y / alpha_y) / h.z;
  }
};

bool is_roughness(const brdf::Parameter& parameter) {
  return parameter.scale == brdf::Scale::logarithmic && parameter.upper <= 10;
}

/// The model's most stretched Ward lobe, if it needs a grid of its own.
std::optional<StretchedLobe> stretched_lobe(const brdf::BoundModel& model) {
  std::optional<StretchedLobe> found;
  double largest = largest_shown_stretch;
  const auto parameters = model.model().shape();
  for (std::size_t p = 0; p + 1 < parameters.size(); ++p) {
    const auto& x = parameters[p];
    const auto& y = parameters[p + 1];
    if (x.term != y.term || !is_roughness(x.descriptor) || !is_roughness(y.descriptor)) continue;
    const double alpha_x = model.shape()[p];
    const double alpha_y = model.shape()[p + 1];
    const double stretch = std::max(alpha_x / alpha_y, alpha_y / alpha_x);
    if (stretch <= largest) continue;
    largest = stretch;
    const bool is_turned = p + 2 < parameters.size() && parameters[p + 2].term == x.term;
    found = StretchedLobe{alpha_x, alpha_y, is_turned ? model.shape()[p + 2] : 0};
  }
  return found;
}

void add_if_compared(std::vector<WeightedPair>& pairs, const WeightedPair& candidate) {
  static const double least_cosine =
      std::cos((material::largest_compared_theta_deg + 1e-6) * (pi / 180));
  if (candidate.pair.wo.z >= least_cosine) pairs.push_back(candidate);
}

/// The viewers within a stretched lobe.
void add_stretched(std::vector<WeightedPair>& pairs, const Direction& wi,
                   const StretchedLobe& lobe) {
  constexpr int rings = 60;
  constexpr int azimuths = 32;
  const double dr = lobe_end / rings;
  const double dpsi = 2 * pi / azimuths;
  for (int ring = 0; ring < rings; ++ring) {
    const double r = (ring + 0.5) * dr;
    for (int k = 0; k < azimuths; ++k) {
      const double along = lobe.alpha_x * r * std::cos(k * dpsi);
      const double across = lobe.alpha_y * r * std::sin(k * dpsi);
      const double x = std::cos(lobe.tangent) * along - std::sin(lobe.tangent) * across;
      const double y = std::sin(lobe.tangent) * along + std::cos(lobe.tangent) * across;
      const double z = 1 / std::sqrt(1 + x * x + y * y);
      const Direction h{x * z, y * z, z};
      const double wi_dot_h = wi.x * h.x + wi.y * h.y + wi.z * h.z;
      if (!(wi_dot_h > 0)) continue;
      const Direction wo{2 * wi_dot_h * h.x - wi.x, 2 * wi_dot_h * h.y - wi.y,
                         2 * wi_dot_h * h.z - wi.z};
      const double dwh = z * z * z * lobe.alpha_x * lobe.alpha_y * r * dr * dpsi;
      add_if_compared(pairs, {{wi, wo}, 4 * wi_dot_h * dwh});
    }
  }
}

void add_viewers(std::vector<WeightedPair>& pairs, const Direction& wi, bool both_sides,
                 const std::optional<StretchedLobe>& lobe) {
  for (const auto& [wo, solid_angle] : brdf::lobe_directions(wi, {.one_side = !both_sides})) {
    const Direction h = brdf::half_vector(wi, wo);
    const bool is_mirrored = wo.x == -wi.x && wo.y == -wi.y;
    if (lobe && !is_mirrored && lobe->radius_of(h) < lobe_end) continue;
    add_if_compared(pairs, {{wi, wo}, solid_angle});
  }
  if (lobe) add_stretched(pairs, wi, *lobe);
}

}  // namespace

std::vector<WeightedPair> lobe_grid(const brdf::BoundModel& model) {
  const material::Incidence incidence = material::default_incidence(model.model());
  const std::optional<StretchedLobe> lobe = stretched_lobe(model);
  std::vector<WeightedPair> pairs;
  for (const double theta_deg : incidence.theta_deg) {
    for (const double phi_deg : incidence.phi_deg) {
      add_viewers(pairs, brdf::direction_from_degrees(theta_deg, phi_deg), incidence.both_sides,
                  lobe);
    }
  }
  return pairs;
}

}  // namespace gonio::trade
