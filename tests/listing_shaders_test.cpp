// The published listings as the shaders that bench/shader_cost counts: run on a device they compute
// what brdf/listings.h computes, so that what is counted is what was published.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "bench/shader_cost_listings.h"
#include "brdf/listings.h"
#include "shader/spirv.h"
#include "tests/vulkan_device_or_skip.h"

namespace gonio::tests {
namespace {

namespace listings = brdf::listings;
using listings::Float3;
using listings::Geometry;

constexpr std::size_t channels = 3;
constexpr float c[channels] = {0.5F, 0.4F, 0.3F};

/// The same values as the functions below have.
constexpr std::string_view parameters = R"(
static const float3 c = float3(0.5, 0.4, 0.3);
static const float3 Ps = 0.3;
static const float roughness = 0.4;
static const float2 roughnesses = float2(0.3, 0.5);
static const float exponent = 25;
static const float2 exponents = float2(30, 12);
static const float3 light_ambient = 0.1;
static const float3 light_diffuse = 0.9;
static const float3 light_specular = 0.7;
static const float gloss = 0.8;
static const float sigma2 = 0.25;
static const float smoothness = 0.6;
static const float metalness = 0.4;
static const float transparency = 0.2;
static const float Rs = 0.3;
)";

constexpr std::string_view kernel = R"(
[[vk::binding(0, 0)]] StructuredBuffer<float> vectors;
[[vk::binding(1, 0)]] RWStructuredBuffer<float> values;
struct Elements {
  uint count;
};
[[vk::push_constant]] ConstantBuffer<Elements> elements;

float3 vector_at(uint i) { return float3(vectors[i], vectors[i + 1u], vectors[i + 2u]); }

[numthreads(64, 1, 1)]
void main(uint3 invocation : SV_DispatchThreadID) {
  uint i = invocation.x;
  if (i >= elements.count) return;
  float3 value = shade(vector_at(9u * i), vector_at(9u * i + 3u), vector_at(9u * i + 6u));
  values[3u * i] = value.x;
  values[3u * i + 1u] = value.y;
  values[3u * i + 2u] = value.z;
}
)";

float ward(const Geometry& at, float colour) {
  return listings::ward_isotropic(at, {.c = colour, .specular = 0.3F, .roughness = 0.4F});
}
float ward_anisotropic(const Geometry& at, float colour) {
  return listings::ward_anisotropic(
      at, {.c = colour, .specular = 0.3F, .roughness_x = 0.3F, .roughness_y = 0.5F});
}
float ashikhmin_shirley(const Geometry& at, float colour) {
  return listings::ashikhmin_shirley(at, {.diffuse = colour, .specular = 0.3F, .nu = 30, .nv = 12});
}
float strauss(const Geometry& at, float colour) {
  return listings::strauss(
      at, {.c = colour, .smoothness = 0.6F, .metalness = 0.4F, .transparency = 0.2F});
}
float oren_nayar(const Geometry& at, float colour) {
  return colour * listings::oren_nayar(at, 0.5F);
}
constexpr listings::PhongLight light{.ambient = 0.1F, .diffuse = 0.9F, .specular = 0.7F};
float phong(const Geometry& at, float colour) {
  return listings::phong(at, {.c = colour, .exponent = 25, .gloss = 0.8F}, light);
}
float blinn_phong(const Geometry& at, float colour) {
  return listings::blinn_phong(at, {.c = colour, .exponent = 25, .gloss = 0.8F}, light);
}

using Listing = float (*)(const Geometry& at, float colour);

/// What each shader has to compute.
const std::map<std::pair<std::string_view, std::string_view>, Listing>& references() {
  static const std::map<std::pair<std::string_view, std::string_view>, Listing> table{
      {{"Ward isotropic", "tan(acos(n.h))"}, ward},
      {{"Ward isotropic", "1/(n.h)^2 - 1"}, ward},
      {{"Ward isotropic", "components of l + v"}, ward},
      {{"Ward anisotropic", "as published"}, ward_anisotropic},
      {{"Ashikhmin-Shirley", "as published"}, ashikhmin_shirley},
      {{"Strauss", "as published"}, strauss},
      {{"Oren-Nayar", "sin and tan of the angles"}, oren_nayar},
      {{"Oren-Nayar", "van Ouwerkerk's rewrite"}, oren_nayar},
      {{"Oren-Nayar", "no normalise, no root"}, oren_nayar},
      {{"Phong", "Phong"}, phong},
      {{"Phong", "Blinn-Phong"}, blinn_phong},
      {{"Phong", "Blinn-Phong by lit()"}, blinn_phong}};
  return table;
}

/// l and v at least 0.1 above the plane of n, and v within a quarter turn of the mirror direction:
/// where no listing gives NaN.
std::vector<Geometry> drawn_geometries(std::size_t count) {
  std::mt19937_64 generator(1);
  std::normal_distribution<float> normal;
  const auto draw = [&] {
    return listings::normalize({normal(generator), normal(generator), normal(generator)});
  };
  std::vector<Geometry> geometries;
  while (geometries.size() < count) {
    const Geometry at{draw(), draw(), draw()};
    constexpr float least = 0.1F;
    const float along_mirror = -listings::dot(listings::reflect(at.l, at.n), at.v);
    if (listings::dot(at.n, at.l) > least && listings::dot(at.n, at.v) > least &&
        along_mirror > least && std::abs(at.n.x) < 1 - least) {
      geometries.push_back(at);
    }
  }
  return geometries;
}

std::vector<float> components_of(const std::vector<Geometry>& geometries) {
  std::vector<float> components;
  for (const Geometry& at : geometries) {
    for (const Float3& v : {at.n, at.l, at.v}) components.insert(components.end(), {v.x, v.y, v.z});
  }
  return components;
}

TEST(ListingShaders, ComputeWhatTheListingsCompute) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const std::vector<Geometry> geometries = drawn_geometries(2000);
  const std::vector<float> input = components_of(geometries);
  const auto count = static_cast<std::uint32_t>(geometries.size());
  std::size_t compared = 0;
  for (const bench::ListingShader& shader : bench::listing_shaders()) {
    const auto reference = references().find({shader.group, shader.name});
    if (reference == references().end()) continue;  // the interface alone, and the texture
    SCOPED_TRACE(std::string(shader.group) + ", " + std::string(shader.name));
    ++compared;
    const std::string text = std::string(parameters).append(shade_function(shader)).append(kernel);
    const auto values = device.run(shader::compile(text, shader::Language::hlsl), input,
                                   channels * geometries.size(), count);
    float largest_error = 0;
    float peak = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const float expected = reference->second(geometries[i / channels], c[i % channels]);
      largest_error = std::max(largest_error, std::abs(values[i] - expected));
      peak = std::max(peak, expected);
    }
    // Vulkan lets acos err by 1e-3 or so, and everything else here by a few roundings.
    const bool has_acos = shader.body.find("acos") != std::string_view::npos;
    EXPECT_LT(largest_error, (has_acos ? 5e-3F : 2e-5F) * peak);
  }
  EXPECT_EQ(compared, references().size());
}

}  // namespace
}  // namespace gonio::tests
