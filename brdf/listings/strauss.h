// The Strauss listing. Source of the model: Strauss, A Realistic Lighting Model for Computer
// Animators, IEEE CG&A 10(6), 1990.
#pragma once

#include "brdf/listings/shader.h"

namespace gonio::brdf::listings {

struct StraussMaterial {
  float c;             // colour
  float smoothness;    // s
  float metalness;     // m
  float transparency;  // t
};

/// F(x) with kf = 1.12: 0 at x = 0, 1 at x = 1.
inline float strauss_fresnel(float x) {
  constexpr float kf = 1.12F;
  constexpr float at_0 = 1 / (kf * kf);
  constexpr float at_1 = 1 / ((1 - kf) * (1 - kf));
  return (1 / ((x - kf) * (x - kf)) - at_0) / (at_1 - at_0);
}

/// G(x) with ks = 1.01: 1 at x = 0, 0 at x = 1.
inline float strauss_shadowing(float x) {
  constexpr float ks = 1.01F;
  constexpr float at_0 = 1 / (ks * ks);
  constexpr float at_1 = 1 / ((1 - ks) * (1 - ks));
  return (at_1 - 1 / ((x - ks) * (x - ks))) / (at_1 - at_0);
}

/// (-(h.v))^(3/(1 - s)), where h is l reflected and points into the surface. NaN where v is more
/// than a quarter turn from the mirror direction; at s = 1, 3/0: 0 beside the mirror direction, and
/// in it 0, NaN or infinity, as its cosine rounds.
inline float strauss_highlight(const Geometry& at, float smoothness) {
  const Float3 h = reflect(at.l, at.n);
  return power(-dot(h, at.v), 3 / (1 - smoothness));
}

/// Listing 4: pi n.l times f_r of `strauss-listing`, with
/// - the dot products n.l and n.v where Strauss has the angle over pi/2, so that F is full at
///   normal incidence and 0 at grazing: that is what makes `strauss-listing` differ from `strauss`;
/// - NaN or worse from strauss_highlight where the model is 0, and at s = 1.
inline float strauss(const Geometry& at, const StraussMaterial& material) {
  const float s = material.smoothness;
  const float m = material.metalness;
  const float t = material.transparency;
  const float n_dot_l = dot(at.n, at.l);
  const float n_dot_v = dot(at.n, at.v);

  const float d = 1 - m * s;
  const float rd = (1 - s * s * s) * (1 - t);
  const float diffuse = n_dot_l * d * rd * material.c;

  const float r = (1 - t) - rd;
  const float fresnel = strauss_fresnel(n_dot_l);
  const float j = fresnel * strauss_shadowing(n_dot_l) * strauss_shadowing(n_dot_v);
  const float reflectivity = minimum(1, r + j * (r + 0.1F));
  const float cs = 1 + m * (1 - fresnel) * (material.c - 1);
  const float specular = reflectivity * cs * strauss_highlight(at, s);
  return maximum(0, diffuse) + maximum(0, specular);
}

}  // namespace gonio::brdf::listings
