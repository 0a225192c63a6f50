// Random pairs of directions, every other one at an extreme: at the pole or as near as the type
// allows, on the edge of the horizon, mirrored, retro-reflected, opposite each other.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "brdf/direction.h"

namespace gonio::tests {

template <class D>
struct DirectionPair {
  brdf::Direction<D> wi, wo;
};

/// Directions are unit to rounding and above the horizon. The same seed gives the same pairs.
template <class D>
class DirectionPairs {
 public:
  /// Cosines of grazing directions are drawn down to `smallest_cosine`.
  DirectionPairs(std::uint64_t seed, D smallest_cosine)
      : generator_(seed), smallest_cosine_(smallest_cosine) {}

  DirectionPair<D> next() {
    const brdf::Direction<D> wi = direction();
    if (count_++ % 2 == 0) return {wi, direction()};
    switch (std::uniform_int_distribution<int>(0, 3)(generator_)) {
      case 0:
        return {wi, {-wi.x, -wi.y, wi.z}};
      case 1:
        return {wi, wi};
      case 2:
        return {wi, near_mirror(wi)};
      default:
        return {wi, on_azimuth_of(wi)};
    }
  }

  /// Uniform over [lowest, highest].
  D uniform(D lowest, D highest) {
    return std::uniform_real_distribution<D>(lowest, highest)(generator_);
  }

 private:
  brdf::Direction<D> direction() {
    switch (std::uniform_int_distribution<int>(0, 7)(generator_)) {
      case 0:
        return {0, 0, 1};
      case 1:
        return near_pole();
      case 2:
      case 3:
        return grazing(azimuth());
      default:
        return with_cosine(uniform(D(1e-3), 1), azimuth());
    }
  }

  D azimuth() { return uniform(0, 2 * std::numbers::pi_v<D>); }

  /// 10^u with u uniform: every order of magnitude is equally likely.
  D any_magnitude(D lowest, D highest) {
    return std::pow(D(10), uniform(std::log10(lowest), std::log10(highest)));
  }

  static brdf::Direction<D> with_cosine(D cosine, D phi) {
    const D sine = std::sqrt((1 - cosine) * (1 + cosine));
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
  }

  brdf::Direction<D> near_pole() {
    const D sine = any_magnitude(std::numeric_limits<D>::min(), D(1e-2));
    const D phi = azimuth();
    return {sine * std::cos(phi), sine * std::sin(phi), std::sqrt((1 - sine) * (1 + sine))};
  }

  brdf::Direction<D> grazing(D phi) {
    return with_cosine(any_magnitude(smallest_cosine_, D(0.1)), phi);
  }

  /// Off the mirror direction by any angle down to the rounding.
  brdf::Direction<D> near_mirror(const brdf::Direction<D>& wi) {
    const D off = any_magnitude(std::numeric_limits<D>::epsilon(), D(1));
    const brdf::Direction<D> wo{-wi.x + off * uniform(-1, 1), -wi.y + off * uniform(-1, 1), wi.z};
    const D length = std::hypot(wo.x, wo.y, wo.z);
    return {wo.x / length, wo.y / length, wo.z / length};
  }

  /// Another polar angle in the plane of incidence, on either side.
  brdf::Direction<D> on_azimuth_of(const brdf::Direction<D>& wi) {
    const D side = uniform(-1, 1) < 0 ? -1 : 1;
    return grazing(std::atan2(side * wi.y, side * wi.x));
  }

  std::mt19937_64 generator_;
  D smallest_cosine_;
  int count_ = 0;
};

}  // namespace gonio::tests
