#include "brdf/lobe_directions.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace gonio::brdf {
namespace {

/// wi mirrored at the unit vector h.
Direction<double> mirrored(const Direction<double>& wi, const Direction<double>& h,
                           double wi_dot_h) {
  return {2 * wi_dot_h * h.x - wi.x, 2 * wi_dot_h * h.y - wi.y, 2 * wi_dot_h * h.z - wi.z};
}

}  // namespace

std::vector<SolidAngleDirection> lobe_directions(const Direction<double>& wi,
                                                 const LobeResolution& resolution) {
  using std::numbers::pi;
  if (!(wi.z > 0)) throw std::invalid_argument("lobe_directions: wi is not above the horizon");
  const double step = 1.0 / resolution.steps_per_e;
  const double psi_step = 2 * pi / resolution.azimuths;
  const double disc = resolution.narrowest * resolution.narrowest * pi;
  std::vector<SolidAngleDirection> directions{{{-wi.x, -wi.y, wi.z}, 4 * wi.z * disc}};
  // Beyond this slope the half vector of a direction above the horizon does not lie: wi.h >= 0.
  const double steepest = 1e3 / wi.z;
  for (int ring = 0;; ++ring) {
    const double t = resolution.narrowest * std::exp((ring + 0.5) * step);
    if (t > steepest) return directions;
    const double cosine = 1 / std::sqrt(1 + t * t);
    const double sine = t * cosine;
    for (int k = 0; k < resolution.azimuths; ++k) {
      const double psi = (k + 0.5) * psi_step;
      const Direction<double> h{sine * std::cos(psi), sine * std::sin(psi), cosine};
      const double wi_dot_h = wi.x * h.x + wi.y * h.y + wi.z * h.z;
      const Direction<double> wo = mirrored(wi, h, wi_dot_h);
      if (!(wi_dot_h > 0 && wo.z > 0)) continue;
      directions.push_back({wo, 4 * wi_dot_h * sine * sine * cosine * step * psi_step});
    }
  }
}

}  // namespace gonio::brdf
