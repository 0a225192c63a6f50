// Phong's and Blinn's lobes as powers of the cosine itself.
#pragma once

#include "bench/naive/naive.h"
#include "brdf/phong.h"

namespace gonio::bench {

template <>
struct Naive<brdf::Phong> {
  template <class N>
  static N value(const std::array<N, 1>& amplitudes, const std::array<N, 1>& shape,
                 const brdf::Direction<N>& wi, const brdf::Direction<N>& wo) {
    return amplitudes[0] * std::pow(naive_mirror_cosine(wi, wo), shape[0]);
  }
};

template <>
struct Naive<brdf::BlinnPhong> {
  template <class N>
  static N value(const std::array<N, 1>& amplitudes, const std::array<N, 1>& shape,
                 const brdf::Direction<N>& wi, const brdf::Direction<N>& wo) {
    return amplitudes[0] * std::pow(unit_half_vector(wi, wo).z, shape[0]);
  }
};

}  // namespace gonio::bench
