// The Ashikhmin-Shirley listing. Source of the model: Ashikhmin & Shirley, An Anisotropic Phong
// BRDF Model, UUCS-00-014, 2000.
#pragma once

#include "brdf/listings/shader.h"

namespace gonio::brdf::listings {

struct AshikhminShirleyMaterial {
  float diffuse;          // Rd of the model
  float specular = 0.3F;  // Rs of the model, which the listing fixes
  float nu;               // exponent along the frame's tangent
  float nv;
};

/// Rs + (1 - Rs)(1 - x)^5, Schlick 1994.
inline float schlick_fresnel(float rs, float x) { return rs + (1 - rs) * power(1 - x, 5); }

/// 28 Rd/(23 pi) (1 - Rs)(1 - (1 - n.l/2)^5)(1 - (1 - n.v/2)^5): the model's own diffuse term.
inline float ashikhmin_shirley_diffuse(const Geometry& at,
                                       const AshikhminShirleyMaterial& material) {
  const float factor = 28 * material.diffuse / (23 * shader_pi) * (1 - material.specular);
  return factor * (1 - power(1 - dot(at.n, at.l) / 2, 5)) * (1 - power(1 - dot(at.n, at.v) / 2, 5));
}

/// The model's specular term times Rs.
inline float ashikhmin_shirley_specular(const Geometry& at,
                                        const AshikhminShirleyMaterial& material) {
  const TangentFrame frame = frame_from_epsilon(at.n);
  const Float3 h = half_vector(at);
  const float h_t = dot(h, frame.tangent);
  const float h_b = dot(h, frame.bitangent);
  const float n_dot_h = dot(at.n, h);
  const float h_dot_l = dot(h, at.l);
  const float exponent =
      (material.nu * h_t * h_t + material.nv * h_b * h_b) / (1 - n_dot_h * n_dot_h);
  const float numerator =
      std::sqrt((material.nu + 1) * (material.nv + 1)) * power(n_dot_h, exponent);
  const float denominator = 8 * shader_pi * h_dot_l * maximum(dot(at.n, at.l), dot(at.n, at.v));
  return material.specular * (numerator / denominator) *
         schlick_fresnel(material.specular, h_dot_l);
}

/// Listing 3: f_r of `ashikhmin-shirley-aniso` where the model has the reflected radiance, with
/// - no factor n.l: 1/(n.l) times too bright, at all angles of incidence but the normal one;
/// - Rs in front of a Fresnel term that starts at Rs: the specular term is Rs = 0.3 of what it
///   should be;
/// - the axes of frame_from_epsilon: for n = z, nu acts along y; NaN at n = +-epsilon;
/// - NaN where n.h rounds to 1, in most pixels within 3e-4 rad of the highlight's centre; farther
///   out the rounding of 1 - (n.h)^2 costs up to 1e-4 of the peak at nu = 10000;
/// - below the horizon whatever comes out.
inline float ashikhmin_shirley(const Geometry& at, const AshikhminShirleyMaterial& material) {
  return ashikhmin_shirley_diffuse(at, material) + ashikhmin_shirley_specular(at, material);
}

}  // namespace gonio::brdf::listings
