// Lambert's, and Oren and Nayar's two forms (SIGGRAPH 1994) through polar angles and azimuths.
#pragma once

#include "bench/naive/naive.h"
#include "brdf/oren_nayar.h"

namespace gonio::bench {

namespace naive_detail {

/// The larger and the smaller polar angle, and the cosine of the azimuth between the directions.
template <class N>
struct OrenNayarAngles {
  N a, b, cos_dphi;
};

template <class N>
OrenNayarAngles<N> oren_nayar_angles(const brdf::Direction<N>& wi, const brdf::Direction<N>& wo) {
  const N theta_i = std::acos(wi.z);
  const N theta_o = std::acos(wo.z);
  return {std::max(theta_i, theta_o), std::min(theta_i, theta_o),
          std::cos(std::atan2(wi.y, wi.x) - std::atan2(wo.y, wo.x))};
}

}  // namespace naive_detail

template <>
struct Naive<brdf::Lambert> {
  template <class N>
  static N value(const std::array<N, 1>& amplitudes, const std::array<N, 0>& /*shape*/,
                 const brdf::Direction<N>& /*wi*/, const brdf::Direction<N>& /*wo*/) {
    return amplitudes[0] / naive_pi<N>;
  }
};

template <>
struct Naive<brdf::OrenNayar> {
  template <class N>
  static N value(const std::array<N, 1>& amplitudes, const std::array<N, 1>& shape,
                 const brdf::Direction<N>& wi, const brdf::Direction<N>& wo) {
    const auto [a, b, cos_dphi] = naive_detail::oren_nayar_angles(wi, wo);
    const N s2 = shape[0] * shape[0];
    const N flat = 1 - N(0.5) * s2 / (s2 + N(0.33));
    const N rough = N(0.45) * s2 / (s2 + N(0.09));
    return amplitudes[0] / naive_pi<N> *
           (flat + rough * std::max(N(0), cos_dphi) * std::sin(a) * std::tan(b));
  }
};

template <>
struct Naive<brdf::OrenNayarFull> {
  template <class N>
  static N value(const std::array<N, 1>& amplitudes, const std::array<N, 1>& shape,
                 const brdf::Direction<N>& wi, const brdf::Direction<N>& wo) {
    const auto [a, b, d] = naive_detail::oren_nayar_angles(wi, wo);
    const N rho = amplitudes[0];
    const N pi = naive_pi<N>;
    const N s2 = shape[0] * shape[0];
    const N g = s2 / (s2 + N(0.09));
    const N turns = 2 * b / pi;
    const N c1 = 1 - N(0.5) * s2 / (s2 + N(0.33));
    const N c2 = N(0.45) * g * (d >= 0 ? std::sin(a) : std::sin(a) - turns * turns * turns);
    const N c3 = N(0.125) * g * std::pow(4 * a * b / (pi * pi), N(2));
    const N direct = c1 + d * c2 * std::tan(b) + (1 - std::abs(d)) * c3 * std::tan((a + b) / 2);
    const N indirect = N(0.17) * s2 / (s2 + N(0.13)) * (1 - d * turns * turns);
    return rho / pi * std::max(N(0), direct) + rho * rho / pi * indirect;
  }
};

}  // namespace gonio::bench
