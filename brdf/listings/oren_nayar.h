// The Oren-Nayar listing: van Ouwerkerk's rewrite without sines and tangents, 2011. Source of the
// model: Oren & Nayar, Generalization of Lambert's Reflectance Model, SIGGRAPH 1994.
#pragma once

#include "brdf/listings/shader.h"

namespace gonio::brdf::listings {

struct OrenNayarFactors {
  float a, b;
};

/// A and B of the simplified model, from sigma^2 in rad^2.
inline OrenNayarFactors oren_nayar_factors(float sigma2) {
  return {1 - 0.5F * (sigma2 / (sigma2 + 0.33F)), 0.45F * (sigma2 / (sigma2 + 0.09F))};
}

/// Listing 5, for a diffuse colour of 1 and sigma in radians: pi n.l times f_r of `oren-nayar` for
/// rho_d = 1, with
/// - NaN where l or v is the normal: normalize(0). Within 0.1 degrees of it the sine carries the
///   rounding of its cosine, up to 1e-4 of the value at sigma = 0.7;
/// - NaN where both are below the horizon or on it, and not 0 where v alone is.
inline float oren_nayar(const Geometry& at, float sigma) {
  const auto [a, b] = oren_nayar_factors(sigma * sigma);
  const float ci = saturate(dot(at.n, at.l));
  const float co = saturate(dot(at.n, at.v));
  const float sines = std::sqrt((1 - ci * ci) * (1 - co * co));
  const Float3 light_plane = normalize(at.l - ci * at.n);
  const Float3 view_plane = normalize(at.v - co * at.n);
  const float cos_phi = saturate(dot(light_plane, view_plane));
  return ci * (a + b * cos_phi * sines / maximum(ci, co));
}

}  // namespace gonio::brdf::listings
