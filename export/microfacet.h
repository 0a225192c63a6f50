// Microfacet lobes as renderers define them: the distribution D of the facets' normals, and Smith's
// masking. From the components of the directions, without trigonometry.
//
// Sources: Walter, Marschner, Li & Torrance, Microfacet Models for Refraction through Rough
// Surfaces, EGSR 2007 (D and G1 of Beckmann and GGX); Heitz, Understanding the Masking-Shadowing
// Function in Microfacet-Based BRDFs, JCGT 2014 (anisotropic forms, height-correlated masking).
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "brdf/direction.h"
#include "brdf/half_vector_lobe.h"
#include "brdf/scalar.h"

namespace gonio::exports {

/// The half vector of wi and wo at unit length, and w.h, the cosine of either to it.
struct Facet {
  brdf::Direction<double> normal;
  double cos_to_w;

  Facet(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo) {
    const brdf::Direction<double> h = brdf::half_vector(wi, wo);
    const double length = brdf::length_above_horizon(h);
    normal = {h.x / length, h.y / length, h.z / length};
    cos_to_w = length / 2;
  }
};

/// Beckmann's D with the roughness along x and along y: exp(-tan^2/alpha^2) / (pi alpha^2 cos^4).
template <class S>
S beckmann_d(const S& alpha_x, const S& alpha_y, const brdf::Direction<double>& normal) {
  const double x = normal.x / normal.z;
  const double y = normal.y / normal.z;
  const S u = x / alpha_x;
  const S v = y / alpha_y;
  const double inverse_cos_squared = 1 + x * x + y * y;
  // Where cos^4 underflows the exponential is 0.
  return brdf::exponential_over<double>(
      S(u * u + v * v),
      S(alpha_x * alpha_y * (std::numbers::pi / (inverse_cos_squared * inverse_cos_squared))));
}

/// D of GGX (Trowbridge & Reitz): 1 / (pi ax ay ((hx/ax)^2 + (hy/ay)^2 + hz^2)^2).
template <class S>
S ggx_d(const S& alpha_x, const S& alpha_y, const brdf::Direction<double>& normal) {
  const S u = normal.x / alpha_x;
  const S v = normal.y / alpha_y;
  const S sum = u * u + v * v + normal.z * normal.z;
  return 1.0 / (std::numbers::pi * alpha_x * alpha_y * sum * sum);
}

/// (alpha tan theta)^2 of a direction above the horizon.
template <class S>
S stretched_tan_squared(const S& alpha_x, const S& alpha_y, const brdf::Direction<double>& w) {
  const S x = alpha_x * (w.x / w.z);
  const S y = alpha_y * (w.y / w.z);
  return x * x + y * y;
}

/// Smith's G1 of GGX: 2 / (1 + sqrt(1 + (alpha tan)^2)).
template <class S>
S ggx_g1(const S& alpha_x, const S& alpha_y, const brdf::Direction<double>& w) {
  using std::sqrt;
  return 2.0 / (1.0 + sqrt(1.0 + stretched_tan_squared(alpha_x, alpha_y, w)));
}

/// Smith's G1 of Beckmann in the rational approximation of Walter et al. 2007, eq. 27.
template <class S>
S beckmann_g1(const S& alpha_x, const S& alpha_y, const brdf::Direction<double>& w) {
  using std::sqrt;
  const S squared = stretched_tan_squared(alpha_x, alpha_y, w);
  // a = 1 / (alpha tan); the formula with numerator and denominator divided by a^2.
  constexpr double largest_a = 1.6;
  const S t = sqrt(squared);
  return brdf::select(brdf::less(squared, S(1 / (largest_a * largest_a))), S(1.0),
                      S((3.535 * t + 2.181) / (t * t + 2.276 * t + 2.577)));
}

/// The height-correlated G / (4 cos_i cos_o) of GGX (Heitz 2014, eq. 99).
template <class S>
S ggx_correlated_visibility(const S& alpha_x, const S& alpha_y, const brdf::Direction<double>& wi,
                            const brdf::Direction<double>& wo) {
  using std::sqrt;
  const auto stretched_length = [&](const brdf::Direction<double>& w) {
    const S x = alpha_x * w.x;
    const S y = alpha_y * w.y;
    return S(sqrt(x * x + y * y + w.z * w.z));
  };
  return 0.5 / (wo.z * stretched_length(wi) + wi.z * stretched_length(wo));
}

/// The smaller of a value and the largest finite number.
template <class S>
S finite(const S& value) {
  const S largest((std::numeric_limits<double>::max)());
  return brdf::select(brdf::less(value, largest), value, largest);
}

}  // namespace gonio::exports
