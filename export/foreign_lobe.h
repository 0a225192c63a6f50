// A renderer's own material, as a formula to be fitted: a type with only static members,
//
//   static constexpr std::array<LobeParameter, N> parameters;
//   static std::vector<std::array<double, N>> starts();
//   template <class S>
//   static std::array<S, 3> f_r(const std::array<S, N>& values, const Direction<double>& wi,
//                               const Direction<double>& wo);   // of R, G and B, in 1/sr
//
// with S = double or an automatic derivative, for directions above the horizon, with x along the
// tangent. Finite within the bounds of the parameters. A start differs from the solution mainly in
// the width of the lobe: several of them, from narrow to wide, find the global minimum.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>

#include "brdf/direction.h"
#include "material/comparison.h"

namespace gonio::exports {

/// How a fit walks along a parameter; `logarithmic` for a width, whose lower bound is above 0.
enum class Walk { linear, logarithmic };

struct LobeParameter {
  std::string_view name;  // the renderer's
  double lower;
  double upper;
  Walk walk = Walk::linear;
};

template <class Lobe>
using LobeValues = std::array<double, Lobe::parameters.size()>;

/// The direction with its azimuth measured from a tangent at `angle` radians.
inline brdf::Direction<double> from_tangent(const brdf::Direction<double>& w, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * w.x + s * w.y, c * w.y - s * w.x, w.z};
}

/// The reflectance of a renderer's material whose tangent lies at the azimuth `tangent` in radians;
/// 0 below the horizon.
template <class Lobe>
material::Reflectance lobe_reflectance(const LobeValues<Lobe>& values, double tangent) {
  return [values, tangent](const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                           std::span<double> f_r) {
    std::array<double, 3> rgb{};
    if (brdf::above_horizon(wi, wo)) {
      rgb =
          Lobe::template f_r<double>(values, from_tangent(wi, tangent), from_tangent(wo, tangent));
    }
    std::copy(rgb.begin(), rgb.end(), f_r.begin());
  };
}

}  // namespace gonio::exports
