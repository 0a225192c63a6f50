#include "brdf/lobe_directions.h"

#include <algorithm>
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

/// The angle of a ring from its u = rings_per_e ln(delta) + rings_per_radian delta, by Newton's
/// iteration for ln(delta), from above: u is convex in it, so that it comes down without a turn.
double angle_of_ring(double u, const LobeResolution& resolution) {
  const double a = resolution.rings_per_e;
  const double b = resolution.rings_per_radian;
  double log_delta = std::min(u / a, std::log(2.0));
  for (int iteration = 0; iteration < 50; ++iteration) {
    const double delta = std::exp(log_delta);
    const double step = (a * log_delta + b * delta - u) / (a + b * delta);
    log_delta -= step;
    if (std::abs(step) < 1e-14) break;
  }
  return std::exp(log_delta);
}

/// The azimuths psi of the half vectors, and the angle that each stands for.
struct Azimuth {
  double psi;
  double width;
};

std::vector<Azimuth> azimuths_of(const LobeResolution& resolution) {
  using std::numbers::pi;
  const double step = 2 * pi / resolution.azimuths;
  std::vector<Azimuth> azimuths;
  if (!resolution.one_side) {
    for (int k = 0; k < resolution.azimuths; ++k) azimuths.push_back({k * step, step});
    return azimuths;
  }
  const int half = resolution.azimuths / 2;
  for (int k = 0; k <= half; ++k) {
    const bool is_in_plane = k == 0 || k == half;
    azimuths.push_back({k * step, is_in_plane ? step : 2 * step});
  }
  return azimuths;
}

}  // namespace

std::vector<SolidAngleDirection> lobe_directions(const Direction<double>& wi,
                                                 const LobeResolution& resolution) {
  using std::numbers::pi;
  if (!(wi.z > 0)) throw std::invalid_argument("lobe_directions: wi is not above the horizon");
  const double a = resolution.rings_per_e;
  const double b = resolution.rings_per_radian;
  const double disc = resolution.narrowest * resolution.narrowest * pi;
  const double plane_of_incidence = std::atan2(wi.y, wi.x);
  const std::vector<Azimuth> azimuths = azimuths_of(resolution);
  const double first = a * std::log(resolution.narrowest) + b * resolution.narrowest;
  const double last = a * std::log(pi / 2) + b * pi / 2;

  std::vector<SolidAngleDirection> directions{{{-wi.x, -wi.y, wi.z}, 4 * wi.z * disc}};
  for (int ring = 0; first + ring + 0.5 < last; ++ring) {
    const double delta = angle_of_ring(first + ring + 0.5, resolution);
    const double width = 1 / (a / delta + b);
    for (const auto& [psi, psi_width] : azimuths) {
      const double azimuth = psi + plane_of_incidence;
      const Direction<double> h{std::sin(delta) * std::cos(azimuth),
                                std::sin(delta) * std::sin(azimuth), std::cos(delta)};
      const double wi_dot_h = wi.x * h.x + wi.y * h.y + wi.z * h.z;
      const Direction<double> wo = mirrored(wi, h, wi_dot_h);
      if (!(wi_dot_h > 0 && wo.z > 0)) continue;
      directions.push_back({wo, 4 * wi_dot_h * std::sin(delta) * width * psi_width});
    }
  }
  return directions;
}

}  // namespace gonio::brdf
