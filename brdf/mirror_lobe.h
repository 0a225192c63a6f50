// The cosine between the viewer and the mirror direction, and its powers: the lobe of Phong and of
// Strauss.
//
// With r = (-wi.x, -wi.y, wi.z), the mirror image of wi, and d = wo - r, r.wo = 1 - d.d/2 for unit
// vectors. Near the mirror direction the logarithm comes from d.d, which keeps the digits that r.wo
// loses: an exponent of 1e7 would show the rounding of r.wo, and of the vectors' norms, as 1e-9.
// The norms move ln(r.wo) only by their relative error there. Far from it, where d.d cancels in
// turn, the logarithm is that of the dot product.
#pragma once

#include <cmath>
#include <limits>

#include "brdf/direction.h"

namespace gonio::brdf {

/// max(0, r.wo) for the mirror image r of wi: whether it is positive, and if so its logarithm.
template <class D>
struct MirrorCosine {
  /// A mask for packs.
  decltype(less(D(0), D(0))) positive;
  /// ln(r.wo): at most 0, and 0 exactly where wo is the mirror direction. Where r.wo is not
  /// positive: the logarithm of the smallest normal number, so that nothing computed from it is
  /// NaN.
  D log;
};

/// The cosine between wo and the mirror image of wi about the normal. Unit directions.
template <class D>
MirrorCosine<D> mirror_cosine(const Direction<D>& wi, const Direction<D>& wo) {
  using std::log;
  using std::log1p;
  const D x = wi.x + wo.x;
  const D y = wi.y + wo.y;
  const D z = wi.z - wo.z;
  const D half_distance2 = (x * x + y * y + z * z) / D(2);
  const D cosine = wi.z * wo.z - wi.x * wo.x - wi.y * wo.y;
  const D smallest((std::numeric_limits<D>::min)());
  const auto near_mirror = less(half_distance2, D(0.5));
  const D from_distance = log1p(-select(near_mirror, half_distance2, D(0)));
  const D from_cosine = log(larger(smallest, cosine));
  return {less(D(0), cosine), select(near_mirror, from_distance, from_cosine)};
}

/// max(0, r.wo)^exponent for an exponent of at least 0; where r.wo <= 0 the value is 0 also for the
/// exponent 0. With Jets for S its derivatives are finite wherever the exponent's are.
template <class S, class D>
S power(const MirrorCosine<D>& cosine, const S& exponent) {
  using std::exp;
  return select(cosine.positive, S(exp(S(exponent * S(cosine.log)))), S(D(0)));
}

}  // namespace gonio::brdf
