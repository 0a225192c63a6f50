// The two Ward listings, and the texture that one of them reads its exponent from. Source of the
// model: Ward, Measuring and Modeling Anisotropic Reflection, SIGGRAPH 1992.
//
// Both return (n.l)(c + specular). The specular term is f_r, as in the model, but the diffuse one
// is c without 1/pi: pi times too bright against its own specular.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "brdf/listings/shader.h"

namespace gonio::brdf::listings {

/// -tan^2 of the angle between normal and half vector, the long way. Near n.h = 1 a float moves in
/// steps of 6e-8 and this in steps of 1.2e-7; at n.h = 0 it is -5.2e14 (minus infinity in truth);
/// NaN where n.h exceeds 1 by rounding.
inline float exponent_by_angle(float n_dot_h) {
  const float tangent = std::tan(std::acos(n_dot_h));
  return -(tangent * tangent);
}

enum class Addressing { clamp, wrap };

/// A 1D texture of one channel, texel centres at (i + 1/2) / N, between which it is linear. The
/// weights are those of float; hardware may round them to 1/256.
inline float sample_linear(std::span<const float> texels, float u, Addressing addressing) {
  const int size = static_cast<int>(texels.size());
  const float position = u * static_cast<float>(size) - 0.5F;
  const float below = std::floor(position);
  const auto texel = [&](int i) {
    const int inside =
        addressing == Addressing::clamp ? std::clamp(i, 0, size - 1) : ((i % size) + size) % size;
    return texels[static_cast<std::size_t>(inside)];
  };
  const int i = static_cast<int>(below);
  const float weight = position - below;
  return texel(i) + weight * (texel(i + 1) - texel(i));
}

/// The 512 texels of the listing: exponent_by_angle(2 i/512 - 1) in the i-th. The last stands for
/// n.h = 0.996, and each is read half a texel from where it belongs.
inline std::array<float, 512> ward_exponent_texels() {
  std::array<float, 512> texels{};
  for (std::size_t i = 0; i < texels.size(); ++i) {
    texels[i] = exponent_by_angle(2 * static_cast<float>(i) / 512 - 1);
  }
  return texels;
}

/// The exponent as the listing reads it, at u = (n.h + 1)/2: half of the texels are never read.
inline float exponent_by_texture(std::span<const float> texels, float n_dot_h,
                                 Addressing addressing = Addressing::clamp) {
  return sample_linear(texels, (n_dot_h + 1) / 2, addressing);
}

struct WardMaterial {
  float c;          // diffuse colour
  float specular;   // Ps, rho_s of the model
  float roughness;  // alpha of the model
};

/// The isotropic listing from the exponent on, which the two below differ in.
inline float ward_isotropic_with(const Geometry& at, const WardMaterial& material, float exponent) {
  const float r2 = material.roughness * material.roughness + 1e-5F;
  const float n_dot_l = dot(at.n, at.l);
  const float n_dot_v = dot(at.n, at.v);
  const float denominator = 4 * shader_pi * r2 * std::sqrt(n_dot_l * n_dot_v);
  return n_dot_l * (material.c + material.specular * std::exp(exponent / r2) / denominator);
}

/// Listing 1. The specular term is `ward` (IsotropicWard<WardLobe>) with
/// - alpha = sqrt(roughness^2 + 1e-5): 0.01 becomes 0.0105, 0.001 becomes 0.0033;
/// - exponent_by_angle's steps in the exponent: at alpha = 0.001 they would be 0.12, which with the
///   rounding of h makes up to 24 % of the peak for n = z, 38 % for any normal, did the bias not
///   blur the lobe;
/// - NaN where n.h rounds to more than 1: 1 in 2,000 pixels within 3e-3 rad of the highlight's
///   centre, and more the nearer;
/// - NaN where one of l and v is below the horizon, a negative value where both are.
inline float ward_isotropic(const Geometry& at, const WardMaterial& material) {
  return ward_isotropic_with(at, material, exponent_by_angle(dot(at.n, half_vector(at))));
}

/// Listing 1 with the texture. The highlight's centre loses 96 % at alpha = 0.05, 54 % at 0.1 and
/// still 0.8 % at 1.
inline float ward_isotropic_by_texture(const Geometry& at, const WardMaterial& material,
                                       std::span<const float> texels) {
  return ward_isotropic_with(at, material, exponent_by_texture(texels, dot(at.n, half_vector(at))));
}

struct WardAnisotropicMaterial {
  float c;
  float specular;
  float roughness_x;  // along the frame's tangent
  float roughness_y;
};

/// Listing 2. The specular term is `ward-approx-aniso` (AnisotropicWard<WardApproxLobe>, Ward's eq.
/// 5b) with
/// - the axes of frame_from_epsilon: for n = z, roughness_x is the model's alpha_y and the other
///   way round; NaN at n = +-epsilon;
/// - 1e-5 added to each roughness itself: a peak 2 % too low at 0.001, 17 % at 0.0001;
/// - NaN and negative values below the horizon as in listing 1.
inline float ward_anisotropic(const Geometry& at, const WardAnisotropicMaterial& material) {
  const float ax = material.roughness_x + 1e-5F;
  const float ay = material.roughness_y + 1e-5F;
  const TangentFrame frame = frame_from_epsilon(at.n);
  const Float3 h = half_vector(at);
  const float along_tangent = dot(h, frame.tangent) / ax;
  const float along_bitangent = dot(h, frame.bitangent) / ay;
  const float beta =
      -2 * (along_tangent * along_tangent + along_bitangent * along_bitangent) / (1 + dot(at.n, h));
  const float n_dot_l = dot(at.n, at.l);
  const float n_dot_v = dot(at.n, at.v);
  const float denominator = 4 * shader_pi * ax * ay * std::sqrt(n_dot_l * n_dot_v);
  return n_dot_l * (material.c + material.specular * std::exp(beta) / denominator);
}

}  // namespace gonio::brdf::listings
