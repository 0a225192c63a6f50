// Ashikhmin and Shirley's model as printed: UUCS-00-014, 2000, eq. 4 and 5.
#pragma once

#include "bench/naive/naive.h"
#include "brdf/ashikhmin_shirley.h"

namespace gonio::bench {

namespace naive_detail {

template <class N>
N cosine_power(const std::array<N, 1>& n, const brdf::Direction<N>& h) {
  return std::pow(h.z, n[0]);
}
template <class N>
N cosine_power(const std::array<N, 2>& n, const brdf::Direction<N>& h) {
  return std::pow(h.z, (n[0] * h.x * h.x + n[1] * h.y * h.y) / (1 - h.z * h.z));
}

template <class N, std::size_t P>
N ashikhmin_shirley_specular(N rs, const std::array<N, P>& n, const brdf::Direction<N>& wi,
                             const brdf::Direction<N>& wo) {
  const brdf::Direction<N> h = unit_half_vector(wi, wo);
  const N x = dot(h, wi);
  const N fresnel = rs + (1 - rs) * std::pow(1 - x, N(5));
  return std::sqrt((n.front() + 1) * (n.back() + 1)) / (8 * naive_pi<N>)*cosine_power(n, h) /
         (x * std::max(wi.z, wo.z)) * fresnel;
}

}  // namespace naive_detail

template <class Exponents>
struct Naive<brdf::AshikhminShirley<Exponents>> {
  template <class N, std::size_t P>
  static N value(const std::array<N, 1>& amplitudes, const std::array<N, P>& shape,
                 const brdf::Direction<N>& wi, const brdf::Direction<N>& wo) {
    return naive_detail::ashikhmin_shirley_specular(amplitudes[0], shape, wi, wo);
  }
};

template <class Exponents>
struct Naive<brdf::CoupledAshikhminShirley<Exponents>> {
  template <class N, std::size_t P>
  static N value(const std::array<N, 2>& amplitudes, const std::array<N, P>& shape,
                 const brdf::Direction<N>& wi, const brdf::Direction<N>& wo) {
    const auto [rd, rs] = amplitudes;
    const auto passed = [](N cosine) { return 1 - std::pow(1 - cosine / 2, N(5)); };
    return 28 * rd / (23 * naive_pi<N>)*(1 - rs) * passed(wi.z) * passed(wo.z) +
           naive_detail::ashikhmin_shirley_specular(rs, shape, wi, wo);
  }
};

}  // namespace gonio::bench
