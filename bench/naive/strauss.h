// Strauss's model as printed (IEEE CG&A 10(6), 1990), and with the listing's argument.
#pragma once

#include "bench/naive/naive.h"
#include "brdf/strauss.h"

namespace gonio::bench {

namespace naive_detail {

template <class N>
N strauss_fresnel(N x) {
  const N kf = N(1.12);
  const auto inverse_square = [](N y) { return 1 / (y * y); };
  return (inverse_square(x - kf) - inverse_square(kf)) /
         (inverse_square(1 - kf) - inverse_square(kf));
}

template <class N>
N strauss_attenuation(N x) {
  const N ks = N(1.01);
  const auto inverse_square = [](N y) { return 1 / (y * y); };
  return (inverse_square(1 - ks) - inverse_square(x - ks)) /
         (inverse_square(1 - ks) - inverse_square(ks));
}

template <class N>
N strauss_argument(brdf::StraussAngle /*of*/, const brdf::Direction<N>& w) {
  return std::acos(w.z) / (naive_pi<N> / 2);
}
template <class N>
N strauss_argument(brdf::StraussCosine /*of*/, const brdf::Direction<N>& w) {
  return w.z;
}

}  // namespace naive_detail

template <class ArgumentOf>
struct Naive<brdf::StraussTerm<ArgumentOf>> {
  template <class N>
  static N value(const std::array<N, 1>& amplitudes, const std::array<N, 3>& shape,
                 const brdf::Direction<N>& wi, const brdf::Direction<N>& wo) {
    using namespace naive_detail;  // NOLINT(google-build-using-namespace)
    const N c = amplitudes[0];
    const auto [s, m, t] = shape;
    const N x_i = strauss_argument(ArgumentOf{}, wi);
    const N fresnel = strauss_fresnel(x_i);
    const N diffuse_reflectance = (1 - s * s * s) * (1 - t);
    const N r = (1 - t) - diffuse_reflectance;
    const N j = fresnel * strauss_attenuation(x_i) *
                strauss_attenuation(strauss_argument(ArgumentOf{}, wo));
    const N reflected = std::min(N(1), r + j * (r + N(0.1)));
    const N colour = 1 + m * (1 - fresnel) * (c - 1);
    const N lobe = std::pow(naive_mirror_cosine(wi, wo), 3 / (1 - s));
    const N light = wi.z * (1 - m * s) * diffuse_reflectance * c + lobe * reflected * colour;
    return light / (naive_pi<N> * wi.z);
  }
};

}  // namespace gonio::bench
