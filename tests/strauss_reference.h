// Strauss's formulas as they are printed, in as many digits as the type has: an evaluation that
// shares nothing with brdf/strauss.h but its input. In float it is the plain form that
// brdf/strauss.h avoids. The mirror direction of vectors that are unit to rounding only is that of
// the normalised vectors.
#pragma once

#include <boost/math/constants/constants.hpp>

#include "brdf/direction.h"
#include "tests/oren_nayar_reference.h"

namespace gonio::tests {

template <class N>
N reference_fresnel(const N& x) {
  const N kf = N(112) / 100;
  const N at_0 = 1 / (kf * kf);
  const N at_1 = 1 / ((1 - kf) * (1 - kf));
  return (1 / ((x - kf) * (x - kf)) - at_0) / (at_1 - at_0);
}

template <class N>
N reference_attenuation(const N& x) {
  const N ks = N(101) / 100;
  const N at_0 = 1 / (ks * ks);
  const N at_1 = 1 / ((1 - ks) * (1 - ks));
  return (at_1 - 1 / ((x - ks) * (x - ks))) / (at_1 - at_0);
}

/// What Strauss's model sees of a pair of directions.
template <class N>
struct StraussAngles {
  N x_i, x_o, cos_i, mirror_cosine;
};

template <class N>
struct NormalisedDirection {
  N x, y, z;
};

template <class N, class D>
NormalisedDirection<N> normalised(const brdf::Direction<D>& w) {
  const N x = exact_in<N>(w.x);
  const N y = exact_in<N>(w.y);
  const N z = exact_in<N>(w.z);
  const N length = sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

/// `listing`: x is the cosine, else the polar angle over pi/2.
template <class N, class D>
StraussAngles<N> strauss_angles(bool listing, const brdf::Direction<D>& wi,
                                const brdf::Direction<D>& wo) {
  const NormalisedDirection<N> i = normalised<N>(wi);
  const NormalisedDirection<N> o = normalised<N>(wo);
  const N mirror_cosine = i.z * o.z - i.x * o.x - i.y * o.y;
  if (listing) return {i.z, o.z, i.z, mirror_cosine};
  const N& quarter = boost::math::constants::half_pi<N>();
  return {polar_angles<N>(wi).theta / quarter, polar_angles<N>(wo).theta / quarter, i.z,
          mirror_cosine};
}

template <class N>
struct StraussParameters {
  N s, m, t;
};

/// max(0, r.wo)^(3/(1-s)); at s = 1 its limit.
template <class N>
N reference_lobe(const N& s, const N& mirror_cosine) {
  using std::pow;
  if (mirror_cosine <= 0) return 0;
  if (s == 1) return mirror_cosine < 1 ? 0 : 1;
  return pow(mirror_cosine, N(3 / (1 - s)));
}

/// f_r = I / (pi cos_i) for the colour c, in 1/sr.
template <class N>
N reference_strauss(const N& c, const StraussParameters<N>& p, const StraussAngles<N>& w) {
  const N d = 1 - p.m * p.s;
  const N rd = (1 - p.s * p.s * p.s) * (1 - p.t);
  const N r = (1 - p.t) - rd;
  const N fresnel = reference_fresnel(w.x_i);
  const N j = fresnel * reference_attenuation(w.x_i) * reference_attenuation(w.x_o);
  const N unbounded = r + j * (r + N(1) / 10);
  const N reflected = unbounded < 1 ? unbounded : N(1);
  const N colour = 1 + p.m * (1 - fresnel) * (c - 1);
  const N intensity =
      w.cos_i * d * rd * c + reference_lobe(p.s, w.mirror_cosine) * reflected * colour;
  return intensity / (boost::math::constants::pi<N>() * w.cos_i);
}

}  // namespace gonio::tests
