// What brdf/scalar.h asks of a Jet of packs, and Eigen of a pack.
#pragma once

#include <ceres/jet.h>

#include "brdf/pack.h"

namespace gonio::brdf {

template <int N>
PackMask less(const ceres::Jet<Pack, N>& a, const ceres::Jet<Pack, N>& b) {
  return less(a.a, b.a);
}

template <int N>
ceres::Jet<Pack, N> select(const PackMask& mask, const ceres::Jet<Pack, N>& a,
                           const ceres::Jet<Pack, N>& b) {
  ceres::Jet<Pack, N> result(select(mask, a.a, b.a));
  for (int k = 0; k < N; ++k) result.v[k] = select(mask, a.v[k], b.v[k]);
  return result;
}

}  // namespace gonio::brdf

template <>
struct Eigen::NumTraits<gonio::brdf::Pack> : Eigen::GenericNumTraits<gonio::brdf::Pack> {};
