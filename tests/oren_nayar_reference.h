// Oren and Nayar's formulas as they are printed, through polar angles and azimuths, in as many
// digits as the type has: an evaluation that shares nothing with brdf/oren_nayar.h but its input.
// In float it is the plain form that brdf/oren_nayar.h avoids.
//
// The input's components are taken as they are, not renormalised. An angle from the normal knows
// the distance from the horizon to the type's digits only: cosines of 1e-300 need 400 of them.
#pragma once

#include <boost/math/constants/constants.hpp>
#include <cmath>

#include "brdf/direction.h"
#include "tests/reference.h"

namespace gonio::tests {

using ManyDigits = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<400>,
                                                 boost::multiprecision::et_off>;

/// The same number in the digits of N. Not by way of Digits: GCC 12 takes the widening of
/// Boost 1.74 for a read past the end.
template <class N, class D>
N exact_in(D value) {
  int exponent = 0;
  const D mantissa = std::frexp(value, &exponent);
  return N(ldexp(N(mantissa), exponent));
}

template <class N>
struct PolarAngles {
  N theta, phi;
};

template <class N, class D>
PolarAngles<N> polar_angles(const brdf::Direction<D>& w) {
  const N x = exact_in<N>(w.x);
  const N y = exact_in<N>(w.y);
  const N z = exact_in<N>(w.z);
  return {atan2(sqrt(x * x + y * y), z), x == 0 && y == 0 ? N(0) : N(atan2(y, x))};
}

/// The two polar angles in order and the cosine of the azimuth between them, 0 at the pole.
template <class N>
struct ReferenceAngles {
  N a, b, cos_dphi;
};

template <class N, class D>
ReferenceAngles<N> reference_angles(const brdf::Direction<D>& wi, const brdf::Direction<D>& wo) {
  const PolarAngles<N> i = polar_angles<N>(wi);
  const PolarAngles<N> o = polar_angles<N>(wo);
  const N a = i.theta > o.theta ? i.theta : o.theta;
  const N b = i.theta > o.theta ? o.theta : i.theta;
  return {a, b, b == 0 ? N(0) : N(cos(i.phi - o.phi))};
}

/// f_r of the simplified form for rho = 1, in 1/sr.
template <class N>
N reference_oren_nayar(const N& sigma, const ReferenceAngles<N>& angles) {
  using std::sin;
  using std::tan;
  const N s2 = sigma * sigma;
  const N a = 1 - s2 / (s2 + N(33) / 100) / 2;
  const N b = N(45) / 100 * s2 / (s2 + N(9) / 100);
  const N lit = angles.cos_dphi > 0 ? angles.cos_dphi : N(0);
  return (a + b * lit * sin(angles.a) * tan(angles.b)) / boost::math::constants::pi<N>();
}

/// f_r = rho direct + rho^2 interreflection, in 1/sr. `direct` is negative where the printed
/// formula is.
template <class N>
struct FullOrenNayar {
  N direct, interreflection;
};

template <class N>
FullOrenNayar<N> reference_full_oren_nayar(const N& sigma, const ReferenceAngles<N>& angles) {
  using std::abs;
  using std::sin;
  using std::tan;
  const N& pi = boost::math::constants::pi<N>();
  const auto& [a, b, d] = angles;
  const N s2 = sigma * sigma;
  const N g = s2 / (s2 + N(9) / 100);
  const N turns = 2 * b / pi;
  const N product = 4 * a * b / (pi * pi);
  const N c1 = 1 - s2 / (s2 + N(33) / 100) / 2;
  const N c2 = N(45) / 100 * g * (d >= 0 ? N(sin(a)) : N(sin(a) - turns * turns * turns));
  const N c3 = N(125) / 1000 * g * product * product;
  const N direct = c1 + d * c2 * tan(b) + (1 - abs(d)) * c3 * tan(N((a + b) / 2));
  const N interreflection = N(17) / 100 * s2 / (s2 + N(13) / 100) * (1 - d * turns * turns);
  return {direct / pi, interreflection / pi};
}

}  // namespace gonio::tests
