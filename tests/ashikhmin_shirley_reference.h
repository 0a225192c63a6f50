// Ashikhmin & Shirley's formulas as they are printed, in 50 decimal digits: an evaluation that
// shares nothing with brdf/ashikhmin_shirley.h but its input.
//
// The half vector's slopes are those of the components as they are (see ward_reference.h); h.wi,
// which both directions share only if their norms are equal, is that of the normalised directions.
#pragma once

#include "brdf/direction.h"
#include "tests/reference.h"

namespace gonio::tests {

struct AshikhminShirleyReference {
  Digits diffuse;   // for Rd = 1, Rs = 0, in 1/sr
  Digits specular;  // for F = 1, in 1/sr
  Digits decay;     // the lobe is the specular part at the mirror direction times exp(-decay)
  Digits cosine;    // h.wi
  Digits darkness;  // (1 - h.wi)^5

  Digits value(const Digits& rd, const Digits& rs) const {
    return rd * (1 - rs) * diffuse + specular * (rs + (1 - rs) * darkness);
  }
};

/// h.wi = cos of half the angle between both directions.
template <class D>
Digits reference_half_angle_cosine(const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
  const Digits i = reference_length(wi);
  const Digits o = reference_length(wo);
  const Digits x = exact(wi.x) / i + exact(wo.x) / o;
  const Digits y = exact(wi.y) / i + exact(wo.y) / o;
  const Digits z = exact(wi.z) / i + exact(wo.z) / o;
  const Digits length = sqrt(x * x + y * y + z * z);
  return (x * exact(wi.x) + y * exact(wi.y) + z * exact(wi.z)) / (i * length);
}

template <class D>
AshikhminShirleyReference ashikhmin_shirley_reference(const Digits& nu, const Digits& nv,
                                                      const brdf::Direction<D>& wi,
                                                      const brdf::Direction<D>& wo) {
  const Digits cos_i = exact(wi.z);
  const Digits cos_o = exact(wo.z);
  const Digits pi = reference_pi();
  const Digits diffuse = 28 / (23 * pi) * (1 - pow(1 - cos_i / 2, 5)) * (1 - pow(1 - cos_o / 2, 5));

  const ReferenceHalfVector h = reference_half_vector(wi, wo);
  const Digits across = h.x * h.x + h.y * h.y;
  const Digits exponent =
      across == 0 ? Digits(0) : Digits((nu * h.x * h.x + nv * h.y * h.y) / across);
  const Digits power = pow(Digits(h.z / h.length), exponent);
  const Digits cosine = reference_half_angle_cosine(wi, wo);
  const Digits specular =
      sqrt((nu + 1) * (nv + 1)) / (8 * pi) * power / (cosine * (cos_i > cos_o ? cos_i : cos_o));
  return {diffuse, specular, -log(power), cosine, pow(1 - cosine, 5)};
}

}  // namespace gonio::tests
