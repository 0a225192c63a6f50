// Ashikhmin and Shirley's anisotropic Phong model, isotropic and anisotropic.
//
//   specular  sqrt((nu+1)(nv+1)) / (8 pi) (n.h)^e / ((h.wi) max(cos_i, cos_o)) F(h.wi),
//             e = (nu hx^2 + nv hy^2) / (hx^2 + hy^2),  F(x) = Rs + (1 - Rs) (1 - x)^5
//   diffuse   28 Rd / (23 pi) (1 - Rs) (1 - (1 - cos_i/2)^5) (1 - (1 - cos_o/2)^5)
//
// Source: Ashikhmin & Shirley, An Anisotropic Phong Light Reflection Model, University of Utah
// UUCS-00-014, 2000; F: Schlick 1994. Units 1/sr.
//
// Each is there twice under the same name: `CoupledAshikhminShirley` is the whole model, whose
// diffuse part receives what the specular one leaves; `AshikhminShirley` is its specular part
// alone, beside another diffuse term.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "brdf/half_vector_lobe.h"
#include "brdf/term.h"

namespace gonio::brdf {

/// One exponent for all azimuths: nu = nv = n.
struct IsotropicExponent {
  static constexpr std::string_view name = "ashikhmin-shirley";
  static constexpr bool anisotropic = false;
  static constexpr std::array<Parameter, 1> shape{cosine_exponent(
      "n", "sharpness: power of n.h, the same in all directions", "Ashikhmin & Shirley 2000")};

  template <class S, class D>
  static S exponent(const std::array<S, 1>& n, const Direction<D>& /*h*/) {
    return n[0];
  }
  template <class S>
  static S normalisation(const std::array<S, 1>& n) {
    return n[0] + S(1);
  }
};

/// nu along the tangent x, nv along the bitangent y.
struct AnisotropicExponents {
  static constexpr std::string_view name = "ashikhmin-shirley-aniso";
  static constexpr bool anisotropic = true;
  static constexpr std::array<Parameter, 2> shape{
      cosine_exponent("nu", "sharpness along the tangent x: power of n.h there",
                      "Ashikhmin & Shirley 2000"),
      cosine_exponent("nv", "sharpness along the bitangent y: power of n.h there",
                      "Ashikhmin & Shirley 2000")};

  /// nu cos^2(phi) + nv sin^2(phi) of the half vector's azimuth; nu at the pole, where n.h is 1 and
  /// any power of it the same.
  template <class S, class D>
  static S exponent(const std::array<S, 2>& n, const Direction<D>& h) {
    using std::abs;
    // Scaled: the squares would underflow near the pole.
    const D scale = larger(D(abs(h.x)), D(abs(h.y)));
    const D x = h.x / scale;
    const D y = h.y / scale;
    const D square = x * x + y * y;
    const auto off_pole = less(D(0), scale);
    return n[0] * S(select(off_pole, D(x * x / square), D(1))) +
           n[1] * S(select(off_pole, D(y * y / square), D(0)));
  }
  template <class S>
  static S normalisation(const std::array<S, 2>& n) {
    using std::sqrt;
    return sqrt((n[0] + S(1)) * (n[1] + S(1)));
  }
};

namespace ashikhmin_shirley_detail {

template <class D>
D at_most_one(const D& x) {
  return select(less(x, D(1)), x, D(1));
}

template <class D>
D fifth_power(const D& x) {
  return x * x * x * x * x;
}

/// 1 - (1 - x)^5 for x from 0 to 1: the geometric sum, which cancels nothing.
template <class D>
D one_minus_fifth_power(const D& x, const D& one_minus_x) {
  const D& y = one_minus_x;
  return at_most_one(D(x * (D(1) + y * (D(1) + y * (D(1) + y * (D(1) + y))))));
}

/// 1 - (1 - c/2)^5: the share that passes the surface at an angle of cosine c.
template <class D>
D passed(const D& cosine) {
  const D x = cosine / D(2);
  return one_minus_fifth_power(x, D(D(1) - x));
}

/// The diffuse part for Rd (1 - Rs) = 1.
template <class D>
D diffuse(const Direction<D>& wi, const Direction<D>& wo) {
  return D(28) / (D(23) * pi<D>()) * passed(wi.z) * passed(wo.z);
}

/// What the Fresnel factor makes of Rs and of 1: F(h.wi) = Rs * of_rs + of_one.
template <class D>
struct Fresnel {
  D of_rs, of_one;
};

/// From h.wi = |wi + wo| / 2 and 1 - h.wi = |wi - wo|^2 / (4 (1 + h.wi)): the dot product has no
/// digits left at grazing angles. Neither factor is above 1, so that no product overflows.
template <class D>
Fresnel<D> fresnel(const Direction<D>& wi, const Direction<D>& wo, const D& half_vector_length) {
  const D x = at_most_one(D(half_vector_length / D(2)));
  const Direction<D> difference{wi.x - wo.x, wi.y - wo.y, wi.z - wo.z};
  const D square =
      difference.x * difference.x + difference.y * difference.y + difference.z * difference.z;
  const D one_minus_x = at_most_one(D(square / (D(4) * (D(1) + x))));
  return {one_minus_fifth_power(x, one_minus_x), fifth_power(one_minus_x)};
}

/// The specular part for Rs * of_rs + of_one: {of_rs, of_one}. Exactly 0 below the horizon.
template <class Exponents, class S, class D>
std::array<S, 2> specular(const std::array<S, Exponents::shape.size()>& n, const Direction<D>& wi,
                          const Direction<D>& wo) {
  const Direction<D> h = half_vector(wi, wo);
  const D length = length_above_horizon(h);
  const D projections = length / D(2) * larger(wi.z, wo.z);  // (h.wi) max(cos_i, cos_o)
  const S lobe =
      exponential_over<D>(S(Exponents::exponent(n, h) * S(minus_log_cosine(h, length))),
                          S(S(D(8) * pi<D>() * projections) / Exponents::normalisation(n)));
  const Fresnel<D> factors = fresnel(wi, wo, length);
  const auto visible = above_horizon(wi, wo);
  return {select(visible, S(lobe * S(factors.of_rs)), S(D(0))),
          select(visible, S(lobe * S(factors.of_one)), S(D(0)))};
}

/// An amplitude in 0..1.
constexpr Parameter share(std::string_view name, std::string_view meaning) {
  return {.name = name,
          .unit = "1",
          .lower = 0,
          .upper = 1,
          .search_lower = 0,
          .search_upper = 1,
          .scale = Scale::linear,
          .meaning = meaning,
          .source = "Ashikhmin & Shirley 2000"};
}

inline constexpr Parameter diffuse_share =
    share("Rd", "diffuse reflectance of the layer under the specular surface");
inline constexpr Parameter specular_share =
    share("Rs", "specular reflectance at normal incidence, F(1)");

inline constexpr std::string_view symbols =
    "h = unit half vector; N = sqrt((nu + 1)(nv + 1)) / (8 pi); e = (nu hx^2 + nv hy^2) / (hx^2 + "
    "hy^2); F = Rs + (1 - Rs)(1 - h.wi)^5; P(x) = 1 - (1 - x/2)^5; nu = nv = n without -aniso";
inline constexpr std::string_view source =
    "Ashikhmin & Shirley, An Anisotropic Phong Light Reflection Model, UUCS-00-014, 2000";

}  // namespace ashikhmin_shirley_detail

/// The specular part alone, for models with a diffuse term of their own.
template <class Exponents>
struct AshikhminShirley {
  static constexpr TermDescription description{
      .name = Exponents::name,
      .kind = TermKind::specular,
      .companion = "lambert",
      .summary = "N (n.h)^e F / ((h.wi) max(cos_i, cos_o)), the specular part alone",
      .source = ashikhmin_shirley_detail::source,
      .symbols = ashikhmin_shirley_detail::symbols,
      .anisotropic = Exponents::anisotropic,
      .coefficients = Coefficients::affine};
  static constexpr std::array<Parameter, 1> amplitudes{ashikhmin_shirley_detail::specular_share};
  static constexpr auto shape = Exponents::shape;

  template <class S>
  static std::array<S, 2> coefficients(const std::array<S, 1>& amplitude) {
    return {amplitude[0], S(1)};
  }

  template <class S, class D>
  static std::array<S, 2> basis(const std::array<S, shape.size()>& n, const Direction<D>& wi,
                                const Direction<D>& wo) {
    return ashikhmin_shirley_detail::specular<Exponents>(n, wi, wo);
  }
};

/// The whole model: the specular part and the diffuse one under it.
template <class Exponents>
struct CoupledAshikhminShirley {
  static constexpr TermDescription description{
      .name = Exponents::name,
      .kind = TermKind::whole,
      .companion = "",
      .summary =
          "N (n.h)^e F / ((h.wi) max(cos_i, cos_o)) + 28 Rd / (23 pi) (1 - Rs) P(cos_i) "
          "P(cos_o)",
      .source = ashikhmin_shirley_detail::source,
      .symbols = ashikhmin_shirley_detail::symbols,
      .anisotropic = Exponents::anisotropic,
      .coefficients = Coefficients::nonlinear};
  static constexpr std::array<Parameter, 2> amplitudes{ashikhmin_shirley_detail::diffuse_share,
                                                       ashikhmin_shirley_detail::specular_share};
  static constexpr auto shape = Exponents::shape;

  template <class S>
  static std::array<S, 3> coefficients(const std::array<S, 2>& amplitude) {
    return {amplitude[0] * (S(1) - amplitude[1]), amplitude[1], S(1)};
  }

  template <class S, class D>
  static std::array<S, 3> basis(const std::array<S, shape.size()>& n, const Direction<D>& wi,
                                const Direction<D>& wo) {
    const auto specular = ashikhmin_shirley_detail::specular<Exponents>(n, wi, wo);
    const D diffuse = ashikhmin_shirley_detail::diffuse(wi, wo);
    return {select(above_horizon(wi, wo), S(diffuse), S(D(0))), specular[0], specular[1]};
  }
};

}  // namespace gonio::brdf
