// Sampling on a Vulkan device against the CPU's sampler of lut/texture.h, texel by texel.
//
// Of the software drivers that are tested SwiftShader and Mesa's lavapipe filter with the whole of
// a float's weight, whatever the sub-texel bits that they report; but lavapipe filters unorm8 in
// integers of 8 bits. A GPU rounds the weight to 1/256.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "lut/texture.h"
#include "shader/spirv.h"
#include "shader/vulkan_device.h"
#include "tests/vulkan_device_or_skip.h"

namespace gonio::tests {
namespace {

using lut::Filter;
using lut::Storage;
using lut::Texture;
using shader::VulkanDevice;

// Each element is u and v; the result is the first two channels there.
constexpr const char* sampling_glsl = R"(#version 450
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Places { vec2 places[]; };
layout(std430, binding = 1) writeonly buffer Values { vec2 values[]; };
layout(set = 0, binding = 2) uniform texture2D image;
layout(set = 0, binding = 3) uniform sampler image_sampler;
layout(push_constant) uniform Elements { uint count; } elements;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < elements.count)
    values[i] = textureLod(sampler2D(image, image_sampler), places[i], 0.0).xy;
})";

struct Place {
  float u, v;
};

struct Values {
  float first, second;
};

std::vector<Values> sampled_by(VulkanDevice& device, const Texture& texture, Filter filter,
                               const std::vector<Place>& places) {
  std::vector<float> input;
  for (const auto& [u, v] : places) input.insert(input.end(), {u, v});
  const shader::SampledTexture sampled{texture, filter};
  static const auto spirv = shader::compile(sampling_glsl, shader::Language::glsl);
  const std::vector<float> output =
      device.run(spirv, input, input.size(), static_cast<std::uint32_t>(places.size()), &sampled);
  std::vector<Values> values;
  for (std::size_t i = 0; i < output.size(); i += 2) values.push_back({output[i], output[i + 1]});
  return values;
}

/// Texels drawn from all that the storage holds between -2, or 0, and 2, or 1.
Texture drawn_texture(int width, int height, int channels, Storage storage) {
  std::mt19937_64 generator(static_cast<std::uint64_t>(width + height + channels));
  const bool is_float = storage == Storage::r32f || storage == Storage::r16f;
  std::uniform_real_distribution<double> draw(is_float ? -2 : 0, is_float ? 2 : 1);
  Texture texture{width, height, channels, storage, {}};
  const auto count = std::size_t(width) * std::size_t(height) * std::size_t(channels);
  while (texture.texels.size() < count) {
    texture.texels.push_back(lut::stored(draw(generator), storage));
  }
  return texture;
}

/// All over and beyond the texture, and at the edges and the centres of texels and next to them.
std::vector<float> drawn_coordinates(int size, std::size_t count, std::mt19937_64& generator) {
  std::uniform_real_distribution<float> anywhere(-0.25F, 1.25F);
  std::uniform_int_distribution<int> half_texel(0, 2 * size);
  std::uniform_int_distribution<int> side(0, 2);
  std::vector<float> drawn;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 2 == 0) {
      drawn.push_back(anywhere(generator));
      continue;
    }
    const float edge = static_cast<float>(half_texel(generator)) / static_cast<float>(2 * size);
    const float far = std::numeric_limits<float>::infinity();
    const std::array beside{std::nextafter(edge, -far), edge, std::nextafter(edge, far)};
    drawn.push_back(beside.at(static_cast<std::size_t>(side(generator))));
  }
  return drawn;
}

std::vector<Place> drawn_places(const Texture& texture) {
  constexpr std::size_t count = 20'000;
  std::mt19937_64 generator(7);
  const std::vector<float> u = drawn_coordinates(texture.width, count, generator);
  std::vector<float> v = drawn_coordinates(texture.height, count, generator);
  std::shuffle(v.begin(), v.end(), generator);  // edges of one axis meet the midst of the other
  std::vector<Place> places;
  for (std::size_t i = 0; i < count; ++i) places.push_back({u[i], v[i]});
  return places;
}

/// The texels that the linear filter blends along an axis.
std::array<int, 2> neighbours(float u, int size) {
  const double below = std::floor(double(u) * size - 0.5);
  const auto texel = [&](double i) { return int(std::clamp(i, 0.0, double(size - 1))); };
  return {texel(below), texel(below + 1)};
}

/// One step of a float of that size.
double ulp(float size) { return double(std::nextafter(size, 2 * size)) - double(size); }

/// Of the texels blended at a place.
struct Blended {
  float largest;  // magnitude
  double spread;
};

Blended blended(const Texture& texture, const Place& place, int channel) {
  std::vector<float> texels;
  for (const int x : neighbours(place.u, texture.width)) {
    for (const int y : neighbours(place.v, texture.height)) {
      const int i = (y * texture.width + x) * texture.channels + channel;
      texels.push_back(texture.texels[static_cast<std::size_t>(i)]);
    }
  }
  const auto [least, most] = std::minmax_element(texels.begin(), texels.end());
  return {std::max(std::abs(*least), std::abs(*most)), double(*most) - double(*least)};
}

/// How many ulp of the largest texel blended a device with exact weights may be off. 2 in one
/// dimension, and for SwiftShader's floats in two; else 2 for each axis, 4 in two dimensions, for
/// lavapipe's order of blending and SwiftShader's decoding of integers: up to 3 are seen.
int allowed_ulp(const shader::DeviceDescription& device, Storage storage, int axes) {
  const bool is_float = storage == Storage::r32f || storage == Storage::r16f;
  const bool is_swiftshader = device.name.find("SwiftShader") != std::string::npos;
  return is_swiftshader && is_float ? 2 : 2 * axes;
}

/// How far a device that filters along so many axes may be from the CPU's sampler.
double allowed_difference(const shader::DeviceDescription& device, Storage storage, int axes,
                          const Blended& texels) {
  const bool is_lavapipe = device.name.find("llvmpipe") != std::string::npos;
  if (is_lavapipe && storage == Storage::unorm8) return axes / 255.0;
  const double rounding = allowed_ulp(device, storage, axes) * ulp(texels.largest);
  if (device.type == shader::DeviceType::cpu) return rounding;
  // Half a step of the weight, and as much of the position.
  return rounding + axes * texels.spread / 256;
}

/// Whether a coordinate is so near a texel's edge that the nearest texel is a matter of rounding:
/// SwiftShader keeps 16 bits of it.
bool is_at_edge(float u, int size) {
  const double position = double(u) * size;
  return std::abs(position - std::round(position)) <= double(size) / 65536;
}

/// The places whose values are further from the CPU's than the device is allowed.
std::vector<std::string> too_far(const shader::DeviceDescription& device, const Texture& texture,
                                 const std::vector<Place>& places,
                                 const std::vector<Values>& found) {
  std::vector<std::string> list;
  const int axes = texture.height == 1 ? 1 : 2;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [u, v] = places[i];
    const auto expected = lut::sample<float>(texture, u, v, Filter::linear);
    const std::array values{found[i].first, found[i].second};
    for (int c = 0; c < texture.channels; ++c) {
      const float value = values.at(std::size_t(c));
      const Blended texels = blended(texture, places[i], c);
      const double allowed = allowed_difference(device, texture.storage, axes, texels);
      const double difference = std::abs(double(value) - double(expected.at(std::size_t(c))));
      if (difference <= allowed) continue;
      list.push_back(
          fmt::format("({}, {}) channel {}: {} for {}, {:.2f} ulp of the largest texel; "
                      "allowed {:.2f}",
                      u, v, c, value, expected.at(std::size_t(c)), difference / ulp(texels.largest),
                      allowed / ulp(texels.largest)));
    }
  }
  return list;
}

struct Size {
  int width, height;
};

class EveryStorage : public testing::TestWithParam<Storage> {};
INSTANTIATE_TEST_SUITE_P(VulkanTexture, EveryStorage, testing::ValuesIn(lut::all_storages),
                         [](const auto& tested) {
                           return std::string(lut::name_of(tested.param));
                         });

// 16 to 4096: the sizes that tables may have. 100: one whose reciprocal no float holds.
constexpr std::array sizes{Size{16, 1},  Size{100, 1},   Size{512, 1},  Size{4096, 1},
                           Size{16, 16}, Size{100, 100}, Size{512, 64}, Size{64, 512}};

TEST_P(EveryStorage, IsFilteredAsTheCpuFiltersIt) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  for (const auto& [width, height] : sizes) {
    for (const int channels : {1, 2}) {
      SCOPED_TRACE(fmt::format("{} x {} x {}", width, height, channels));
      const Texture texture = drawn_texture(width, height, channels, GetParam());
      const std::vector<Place> places = drawn_places(texture);
      const auto found = sampled_by(device, texture, Filter::linear, places);
      EXPECT_THAT(too_far(device.description(), texture, places, found), testing::IsEmpty());
    }
  }
}

TEST_P(EveryStorage, GivesTheNearestTexelWithoutAFilter) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  for (const auto& [width, height] : sizes) {
    SCOPED_TRACE(fmt::format("{} x {}", width, height));
    const Texture texture = drawn_texture(width, height, 2, GetParam());
    const std::vector<Place> places = drawn_places(texture);
    const auto found = sampled_by(device, texture, Filter::nearest, places);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto [u, v] = places[i];
      if (is_at_edge(u, width) || is_at_edge(v, height)) continue;
      ++compared;
      const auto expected = lut::sample<float>(texture, u, v, Filter::nearest);
      // A driver need not decode a normalised integer to the last digit.
      EXPECT_NEAR(found[i].first, expected[0], ulp(std::abs(expected[0]))) << u << ' ' << v;
      EXPECT_NEAR(found[i].second, expected[1], ulp(std::abs(expected[1]))) << u << ' ' << v;
    }
    EXPECT_GT(compared, places.size() / 4);
  }
}

TEST(VulkanTexture, HoldsEveryHalfFloatAsItIs) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  // Every finite number of 16 bits, subnormal ones among them: 63488 of them, of both signs.
  constexpr int width = 256;
  constexpr int height = 248;
  Texture texture{width, height, 1, Storage::r16f, {}};
  for (int code = 0; code < width * height; ++code) {
    const int exponent = code / 2 >> 10;
    const int mantissa = code / 2 & 1023;
    const float magnitude = exponent == 0
                                ? std::ldexp(static_cast<float>(mantissa), -24)
                                : std::ldexp(static_cast<float>(1024 + mantissa), exponent - 25);
    texture.texels.push_back(code % 2 == 0 ? magnitude : -magnitude);
  }
  std::vector<Place> centres;
  for (int i = 0; i < width * height; ++i) {
    const int row = i / width;
    centres.push_back({(static_cast<float>(i % width) + 0.5F) / static_cast<float>(width),
                       (static_cast<float>(row) + 0.5F) / static_cast<float>(height)});
  }
  const auto found = sampled_by(device, texture, Filter::nearest, centres);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].first, texture.texels[i]) << i;
}

TEST(VulkanTexture, LargerThanTheDeviceTakesIsRefusedWithTheLimit) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  // Devices take 16384 or 32768 texels each way, none a million.
  const Texture texture = drawn_texture(1'000'000, 1, 1, Storage::unorm8);
  try {
    sampled_by(device, texture, Filter::nearest, {{0.5F, 0.5F}});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'" + device.description().name + "'"));
    EXPECT_THAT(error.what(),
                testing::ContainsRegex("found a texture of 1000000 x 1 texels, expected at most "
                                       "[0-9]+ each way.*the CPU"));
  }
}

TEST(VulkanTexture, IsFilledAnewForEachRun) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  for (const float value : {0.25F, 0.75F}) {
    const Texture texture{16, 1, 1, Storage::r32f, std::vector<float>(16, value)};
    const auto found = sampled_by(device, texture, Filter::linear, {{0.3F, 0.5F}});
    EXPECT_EQ(found.front().first, value);
    EXPECT_EQ(found.front().second, 0);  // a channel that the texture has not
  }
}

}  // namespace
}  // namespace gonio::tests
