// The lobes of Phong and Blinn straight from their formulas, in 50 decimal digits: an evaluation
// that shares nothing with brdf/phong.h but its input.
//
// Phong's lobe is that of the normalised directions: an exponent of 1e6 would show the rounding of
// their norms. Blinn's is that of the components as they are (see ward_reference.h).
#pragma once

#include "brdf/phong.h"
#include "tests/reference.h"

namespace gonio::tests {

/// The cosine whose power the lobe is: r.wo.
template <class D>
Digits reference_cosine(brdf::Phong /*lobe*/, const brdf::Direction<D>& wi,
                        const brdf::Direction<D>& wo) {
  const Digits dot =
      exact(wi.z) * exact(wo.z) - exact(wi.x) * exact(wo.x) - exact(wi.y) * exact(wo.y);
  return dot / (reference_length(wi) * reference_length(wo));
}

/// The cosine whose power the lobe is: n.h.
template <class D>
Digits reference_cosine(brdf::BlinnPhong /*lobe*/, const brdf::Direction<D>& wi,
                        const brdf::Direction<D>& wo) {
  const ReferenceHalfVector h = reference_half_vector(wi, wo);
  return h.z / h.length;
}

/// max(0, cosine)^n, for ks = 1 in 1/sr; 0^0 is 0.
inline Digits reference_power(const Digits& cosine, const Digits& n) {
  return cosine > 0 ? Digits(pow(cosine, n)) : Digits(0);
}

}  // namespace gonio::tests
