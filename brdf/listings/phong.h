// The three listings with a power of a cosine: Phong (Phong, Illumination for Computer Generated
// Pictures, CACM 18(6), 1975), Blinn-Phong (Blinn, Models of Light Reflection for Computer
// Synthesized Pictures, SIGGRAPH 1977), and Blinn-Phong by the shading language's lit().
//
// Classic convention: the specular term is not multiplied by n.l. With ks = Ls/pi (equal at normal
// incidence) and rho_d = Ld c each is pi n.l f_r of the model, but for
// - the specular term: 1/(n.l) times brighter than the model's, 2 times at 60 degrees;
// - the ambient term La c, which no BRDF has;
// - `gloss`, at which cos^p is cut: 1 leaves it alone;
// - v below the horizon, which is not looked at.
#pragma once

#include "brdf/listings/shader.h"

namespace gonio::brdf::listings {

struct PhongMaterial {
  float c;         // diffuse colour
  float exponent;  // p, 1..255
  float gloss;     // upper bound of cos^p: the alpha of the colour texture, 0..1
};

struct PhongLight {
  float ambient;   // La
  float diffuse;   // Ld
  float specular;  // Ls
};

/// Listing 6: `lambert+phong`, but as above.
inline float phong(const Geometry& at, const PhongMaterial& material, const PhongLight& light) {
  const float ambient = light.ambient * material.c;
  const float n_dot_l = dot(at.n, at.l);
  if (!(n_dot_l > 0)) return ambient;
  const Float3 r = normalize(2 * n_dot_l * at.n - at.l);
  const float lobe = power(saturate(dot(r, at.v)), material.exponent);
  return ambient + light.diffuse * n_dot_l * material.c +
         light.specular * minimum(lobe, material.gloss);
}

/// Listing 7: `lambert+blinn-phong`, but as above. At the same exponent its highlight is 2 times as
/// wide as Phong's in the plane of incidence and 2 cos(theta_i) times across it: there the narrower
/// beyond 60 degrees, and the smaller in area beyond 75.5 degrees.
inline float blinn_phong(const Geometry& at, const PhongMaterial& material,
                         const PhongLight& light) {
  const float ambient = light.ambient * material.c;
  const float n_dot_l = dot(at.n, at.l);
  if (!(n_dot_l > 0)) return ambient;
  const float lobe = power(saturate(dot(at.n, half_vector(at))), material.exponent);
  return ambient + light.diffuse * n_dot_l * material.c +
         light.specular * minimum(lobe, material.gloss);
}

/// The factors that lit() returns, whose fourth is 1 as well.
struct Lit {
  float ambient, diffuse, specular;
};

inline Lit lit(float n_dot_l, float n_dot_h, float exponent) {
  return {1, maximum(0, n_dot_l), n_dot_l < 0 || n_dot_h < 0 ? 0 : power(n_dot_h, exponent)};
}

/// Listing 8: listing 7 by lit(). The same but at n.l = 0, where lit() still has a highlight.
inline float blinn_phong_by_lit(const Geometry& at, const PhongMaterial& material,
                                const PhongLight& light) {
  const Lit factors = lit(dot(at.n, at.l), dot(at.n, half_vector(at)), material.exponent);
  return light.ambient * factors.ambient * material.c +
         light.diffuse * factors.diffuse * material.c +
         light.specular * minimum(factors.specular, material.gloss);
}

}  // namespace gonio::brdf::listings
