// The published shader listings and their rivals as HLSL pixel shaders, for counting what they
// cost. Their arithmetic is that of brdf/listings.h, in three channels and with the parameters as
// uniforms, as published; the rivals are those of bench/listing_kernels.cpp.
//
// All have one interface: the normal, the direction to the light and that to the viewer are
// interpolated, and normalised by the shader.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace gonio::bench {

struct ListingShader {
  std::string_view group;  // what computes the same has the same
  std::string_view name;
  /// Statements from float3 n, l, v to `return`.
  std::string_view body;
  /// Direct3D 10 instructions that were published for it; 0 where none were.
  int published = 0;
};

std::span<const ListingShader> listing_shaders();

/// `float3 shade(float3 n, float3 l, float3 v)` in HLSL, for unit vectors. It takes the parameters
/// to be declared before it: float3 c, Ps, light_ambient, light_diffuse, light_specular; float2
/// roughnesses, exponents; float roughness, exponent, gloss, sigma2, smoothness, metalness,
/// transparency, Rs.
std::string shade_function(const ListingShader& listing);

/// The whole pixel shader, with the parameters as uniforms.
std::string pixel_shader(const ListingShader& listing);

}  // namespace gonio::bench
