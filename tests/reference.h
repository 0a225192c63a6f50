// What the references of the models share: 50 decimal digits, with exponents that do not run out.
#pragma once

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "brdf/direction.h"

namespace gonio::tests {

using Digits = boost::multiprecision::cpp_bin_float_50;

/// The same number in 50 digits; the conversion of Boost 1.74 loses denormal ones.
template <class D>
Digits exact(D value) {
  int exponent = 0;
  const D mantissa = std::frexp(value, &exponent);
  return ldexp(Digits(mantissa), exponent);
}

template <class D>
double relative_error(D value, const Digits& truth) {
  return abs((exact(value) - truth) / truth).template convert_to<double>();
}

template <class D>
Digits reference_length(const brdf::Direction<D>& w) {
  return sqrt(exact(w.x) * exact(w.x) + exact(w.y) * exact(w.y) + exact(w.z) * exact(w.z));
}

struct ReferenceHalfVector {
  Digits x, y, z, length;
};

template <class D>
ReferenceHalfVector reference_half_vector(const brdf::Direction<D>& wi,
                                          const brdf::Direction<D>& wo) {
  const Digits x = exact(wi.x) + exact(wo.x);
  const Digits y = exact(wi.y) + exact(wo.y);
  const Digits z = exact(wi.z) + exact(wo.z);
  const Digits length = sqrt(x * x + y * y + z * z);
  return {x, y, z, length};
}

inline Digits reference_pi() { return boost::math::constants::pi<Digits>(); }

}  // namespace gonio::tests
