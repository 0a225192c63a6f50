// The four Ward lobes straight from their formulas, in 50 decimal digits and with exponents that
// do not run out: an evaluation that shares nothing with brdf/ward.h but its input.
//
// The input's components are taken as they are, not renormalised: at grazing angles the rounding
// of a float or double input moves a half vector more than the evaluation's own error.
#pragma once

#include "brdf/ward.h"
#include "tests/reference.h"

namespace gonio::tests {

struct ReferenceValue {
  Digits value;     // f_r for rho_s = 1, in 1/sr
  Digits exponent;  // of E = exp(-exponent)
};

/// ((hx/ax)^2 + (hy/ay)^2) / hz^2, Ward 1992 eq. 5a
inline Digits reference_exponent(const ReferenceHalfVector& h, const Digits& ax, const Digits& ay) {
  const Digits x = h.x / ax;
  const Digits y = h.y / ay;
  return (x * x + y * y) / (h.z * h.z);
}

/// The same through the angles of the half vector, tan^2(delta) (cos^2(phi) / ax^2 +
/// sin^2(phi) / ay^2), Ward 1992 eq. 4: loses all digits towards the horizon.
inline Digits reference_exponent_by_angles(const ReferenceHalfVector& h, const Digits& ax,
                                           const Digits& ay) {
  const Digits phi = atan2(h.y, h.x);
  const Digits c = cos(phi) / ax;
  const Digits s = sin(phi) / ay;
  const Digits t = tan(Digits(acos(Digits(h.z / h.length))));
  return t * t * (c * c + s * s);
}

template <class D>
ReferenceValue reference(brdf::WardLobe /*lobe*/, const Digits& ax, const Digits& ay,
                         const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
  const Digits exponent = reference_exponent(reference_half_vector(wi, wo), ax, ay);
  const Digits cosines = exact(wi.z) * exact(wo.z);
  return {exp(-exponent) / (4 * reference_pi() * ax * ay * sqrt(cosines)), exponent};
}

template <class D>
ReferenceValue reference(brdf::WardApproxLobe /*lobe*/, const Digits& ax, const Digits& ay,
                         const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
  const ReferenceHalfVector h = reference_half_vector(wi, wo);
  const Digits x = h.x / h.length / ax;
  const Digits y = h.y / h.length / ay;
  const Digits exponent = 2 * (x * x + y * y) / (1 + h.z / h.length);
  const Digits cosines = exact(wi.z) * exact(wo.z);
  return {exp(-exponent) / (4 * reference_pi() * ax * ay * sqrt(cosines)), exponent};
}

template <class D>
ReferenceValue reference(brdf::WardDuerLobe /*lobe*/, const Digits& ax, const Digits& ay,
                         const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
  const Digits exponent = reference_exponent(reference_half_vector(wi, wo), ax, ay);
  const Digits cosines = exact(wi.z) * exact(wo.z);
  return {exp(-exponent) / (4 * reference_pi() * ax * ay * cosines), exponent};
}

template <class D>
ReferenceValue reference(brdf::WardGmdLobe /*lobe*/, const Digits& ax, const Digits& ay,
                         const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
  const ReferenceHalfVector h = reference_half_vector(wi, wo);
  const Digits exponent = reference_exponent(h, ax, ay);
  const Digits z2 = h.z * h.z;
  return {exp(-exponent) * h.length * h.length / (reference_pi() * ax * ay * z2 * z2), exponent};
}

}  // namespace gonio::tests
