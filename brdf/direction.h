// Directions in the local frame of the surface: x = tangent (along the brushing), y = bitangent,
// z = surface normal, right-handed. wi points to the light, wo to the viewer, both away from the
// surface. theta is measured from z, phi from x towards y.
#pragma once

#include <cmath>
#include <numbers>

#include "brdf/scalar.h"

namespace gonio::brdf {

/// A direction by its Cartesian components; unit length is the caller's duty.
template <class T>
struct Direction {
  T x, y, z;
};

/// A direction to the light and one to the viewer.
template <class T>
struct DirectionPair {
  Direction<T> wi, wo;
};

/// The direction with polar angle `theta` and azimuth `phi`, both in radians.
inline Direction<double> direction_from_radians(double theta, double phi) {
  const double sin_theta = std::sin(theta);
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), std::cos(theta)};
}

/// The direction with polar angle `theta` and azimuth `phi`, both in degrees.
inline Direction<double> direction_from_degrees(double theta, double phi) {
  constexpr double radians_per_degree = std::numbers::pi / 180;
  return direction_from_radians(theta * radians_per_degree, phi * radians_per_degree);
}

/// True if both directions are above the horizon; every model is exactly 0 elsewhere.
template <class T>
auto above_horizon(const Direction<T>& wi, const Direction<T>& wo) {
  return both(less(T(0), wi.z), less(T(0), wo.z));
}

/// The half vector h = wi + wo, left unnormalised: ratios of its components need no square root
/// and keep all digits.
template <class T>
Direction<T> half_vector(const Direction<T>& wi, const Direction<T>& wo) {
  return {wi.x + wo.x, wi.y + wo.y, wi.z + wo.z};
}

}  // namespace gonio::brdf
