// MERL's coordinates by their definition, a second way of computing them.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

#include "brdf/direction.h"
#include "table/formats/half_difference.h"

namespace gonio::tests::merl_reference {

using brdf::Direction;
using table::HalfDifference;

inline Direction<double> any_direction(std::mt19937& random) {
  std::uniform_real_distribution<double> theta(0.01, std::numbers::pi / 2 - 0.01);
  std::uniform_real_distribution<double> phi(-std::numbers::pi, std::numbers::pi);
  const double polar = theta(random);
  return brdf::direction_from_radians(polar, phi(random));
}

/// `v` turned about a unit axis, by Rodrigues' formula.
inline Direction<double> turned(const Direction<double>& v, const Direction<double>& axis,
                                double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const double along = (v.x * axis.x + v.y * axis.y + v.z * axis.z) * (1 - c);
  return {v.x * c + (axis.y * v.z - axis.z * v.y) * s + axis.x * along,
          v.y * c + (axis.z * v.x - axis.x * v.z) * s + axis.y * along,
          v.z * c + (axis.x * v.y - axis.y * v.x) * s + axis.z * along};
}

/// By the definition: the turns that bring h to the normal bring wi to d.
inline HalfDifference turned_to_the_normal(const Direction<double>& wi,
                                           const Direction<double>& wo) {
  const Direction<double> h = brdf::half_vector(wi, wo);
  const double length = std::sqrt(h.x * h.x + h.y * h.y + h.z * h.z);
  const double theta_h = std::acos(h.z / length);
  const double phi_h = std::atan2(h.y, h.x);
  const Direction<double> d = turned(turned(wi, {0, 0, 1}, -phi_h), {0, 1, 0}, -theta_h);
  return {theta_h, phi_h, std::acos(d.z), std::atan2(d.y, d.x)};
}

/// The bin as the database describes it: floors of the coordinates by the definition.
inline std::size_t described_bin(const Direction<double>& wi, const Direction<double>& wo) {
  const HalfDifference at = turned_to_the_normal(wi, wo);
  const double phi_d = at.phi_d < 0 ? at.phi_d + std::numbers::pi : at.phi_d;
  const auto h = static_cast<std::size_t>(90 * std::sqrt(at.theta_h / (std::numbers::pi / 2)));
  const auto d = static_cast<std::size_t>(at.theta_d / (std::numbers::pi / 2) * 90);
  const auto p = static_cast<std::size_t>(phi_d / std::numbers::pi * 180);
  return p % 180 + 180 * (d + 90 * h);
}

}  // namespace gonio::tests::merl_reference
