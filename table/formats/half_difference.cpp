#include "table/formats/half_difference.h"

#include <cmath>

namespace gonio::table {

namespace {

using brdf::Direction;

double length(const Direction<double>& v) { return std::hypot(v.x, v.y, v.z); }

/// Turns about y by theta, then about z by phi: the normal becomes the direction (theta, phi).
Direction<double> turned(const Direction<double>& v, double theta, double phi) {
  const double x = std::cos(theta) * v.x + std::sin(theta) * v.z;
  const double z = std::cos(theta) * v.z - std::sin(theta) * v.x;
  return {std::cos(phi) * x - std::sin(phi) * v.y, std::sin(phi) * x + std::cos(phi) * v.y, z};
}

}  // namespace

brdf::DirectionPair<double> directions_from(const HalfDifference& coordinates) {
  const Direction<double> d = brdf::direction_from_radians(coordinates.theta_d, coordinates.phi_d);
  return {turned(d, coordinates.theta_h, coordinates.phi_h),
          turned({-d.x, -d.y, d.z}, coordinates.theta_h, coordinates.phi_h)};
}

HalfDifference half_difference(const Direction<double>& wi, const Direction<double>& wo,
                               double tolerance) {
  const Direction<double> h = brdf::half_vector(wi, wo);
  // Perpendicular to h; its length over that of h is tan(theta_d) without a cancellation.
  const Direction<double> e{wi.x - wo.x, wi.y - wo.y, wi.z - wo.z};
  const double from_normal = std::hypot(h.x, h.y);
  const double theta_h = std::atan2(from_normal, h.z);
  const double phi_h = from_normal <= 2 * tolerance ? 0 : std::atan2(h.y, h.x);
  const double along =
      std::cos(theta_h) * (std::cos(phi_h) * e.x + std::sin(phi_h) * e.y) - std::sin(theta_h) * e.z;
  const double across = std::cos(phi_h) * e.y - std::sin(phi_h) * e.x;
  return {.theta_h = theta_h,
          .phi_h = phi_h,
          .theta_d = std::atan2(length(e), length(h)),
          .phi_d = std::atan2(across, along)};
}

}  // namespace gonio::table
