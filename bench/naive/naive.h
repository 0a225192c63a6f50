// The models as textbooks print them: angles by acos and atan2, powers of cosines, normalised
// vectors, differences left as differences. What the stable forms of brdf/ are compared with.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "brdf/direction.h"

namespace gonio::bench {

/// f_r of the term T in 1/sr, in the precision N; specialised for every term:
///
///   template <class N>
///   static N value(const std::array<N, K>& amplitudes, const std::array<N, P>& shape,
///                  const brdf::Direction<N>& wi, const brdf::Direction<N>& wo);
template <class T>
struct Naive;

template <class N>
inline constexpr N naive_pi = std::numbers::pi_v<N>;

template <class N>
N dot(const brdf::Direction<N>& a, const brdf::Direction<N>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The half vector, normalised.
template <class N>
brdf::Direction<N> unit_half_vector(const brdf::Direction<N>& wi, const brdf::Direction<N>& wo) {
  const brdf::Direction<N> h = brdf::half_vector(wi, wo);
  const N length = std::sqrt(dot(h, h));
  return {h.x / length, h.y / length, h.z / length};
}

/// max(0, cosine) between wo and the mirror image of wi.
template <class N>
N naive_mirror_cosine(const brdf::Direction<N>& wi, const brdf::Direction<N>& wo) {
  return std::max(N(0), wi.z * wo.z - wi.x * wo.x - wi.y * wo.y);
}

}  // namespace gonio::bench
