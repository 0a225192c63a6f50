// What a texel can hold, and sampling against filters written another way.
#include <gtest/gtest.h>
#include <half.h>

#include <cmath>
#include <limits>
#include <random>

#include "brdf/listings/ward.h"
#include "lut/texture.h"

namespace gonio::lut {
namespace {

Texture random_texture(int width, int height, int channels) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  Texture texture{.width = width, .height = height, .channels = channels, .texels = {}};
  for (int i = 0; i < width * height * channels; ++i) texture.texels.push_back(uniform(generator));
  return texture;
}

/// The linear filter as a sum over all texels, each weighted by its tent; the ends go on outside.
double tent_filtered(const Texture& texture, double u, double v, int channel) {
  const auto tent = [](double position, int texel, int size) {
    const double distance = std::abs(position - texel - 0.5);
    const bool is_outside = (texel == 0 && position < 0.5) ||
                            (texel == size - 1 && position > static_cast<double>(size) - 0.5);
    return is_outside ? 1.0 : std::max(0.0, 1 - distance);
  };
  double sum = 0;
  std::size_t i = static_cast<std::size_t>(channel);
  for (int y = 0; y < texture.height; ++y) {
    for (int x = 0; x < texture.width; ++x) {
      sum += tent(u * texture.width, x, texture.width) *
             tent(v * texture.height, y, texture.height) * double{texture.texels[i]};
      i += static_cast<std::size_t>(texture.channels);
    }
  }
  return sum;
}

TEST(LutTexture, HalvesAreRoundedAsImathRoundsThem) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<float> exponent(-30, 16);
  for (int i = 0; i < 100000; ++i) {
    const float value = std::exp2(exponent(generator)) * (i % 2 == 0 ? 1.0F : -1.0F);
    if (std::abs(value) > 65504) continue;
    EXPECT_EQ(stored(double{value}, Storage::r16f), static_cast<float>(half(value))) << value;
  }
  // The middle between two neighbours goes to the even one.
  EXPECT_EQ(stored(1 + 0x1p-11, Storage::r16f), 1);
  EXPECT_EQ(stored(1 + 3 * 0x1p-11, Storage::r16f), 1 + 0x1p-9);
}

TEST(LutTexture, WhatIsTooLargeForTheStorageSaturates) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(stored(-infinity, Storage::r16f), -65504);
  EXPECT_EQ(stored(1e5, Storage::r16f), 65504);
  EXPECT_EQ(stored(-infinity, Storage::r32f), -std::numeric_limits<float>::max());
  for (const Storage storage : {Storage::unorm16, Storage::unorm8}) {
    EXPECT_EQ(stored(-0.5, storage), 0);
    EXPECT_EQ(stored(infinity, storage), 1);
  }
}

TEST(LutTexture, IntegersHoldTheNearestOfTheirSteps) {
  EXPECT_EQ(stored(0.4999 / 255, Storage::unorm8), 0);
  EXPECT_EQ(stored(0.5001 / 255, Storage::unorm8), 1.0F / 255);
  EXPECT_EQ(stored(0.5, Storage::unorm16), 32768.0F / 65535);  // 32767.5: to the even one
}

TEST(LutTexture, LinearSamplingIsTheTentFilter) {
  for (const auto& [width, height] : {std::pair{16, 1}, std::pair{17, 16}}) {
    const Texture texture = random_texture(width, height, 2);
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> beyond(-0.2, 1.2);
    for (int i = 0; i < 2000; ++i) {
      const double u = beyond(generator);
      const double v = beyond(generator);
      const auto found = sample(texture, u, v, Filter::linear);
      for (int c = 0; c < 2; ++c) {
        EXPECT_NEAR(found[static_cast<std::size_t>(c)], tent_filtered(texture, u, v, c), 1e-14);
      }
    }
  }
}

TEST(LutTexture, ATexelIsReadAtItsCentreByEitherFilter) {
  const Texture texture = random_texture(64, 32, 1);
  auto next = texture.texels.begin();
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const float u = (static_cast<float>(x) + 0.5F) / 64;
      const float v = (static_cast<float>(y) + 0.5F) / 32;
      const float texel = *next++;
      EXPECT_EQ(sample(texture, u, v, Filter::linear)[0], texel);
      EXPECT_EQ(sample(texture, u, v, Filter::nearest)[0], texel);
      // Up to the border of the texel, which is 1/128 away.
      EXPECT_EQ(sample(texture, u + 0.99F / 128, v, Filter::nearest)[0], texel);
      EXPECT_EQ(sample(texture, u - 0.99F / 128, v, Filter::nearest)[0], texel);
    }
  }
}

// The same operations in the same order.
TEST(LutTexture, FloatSamplingIsThatOfThePublishedListingBitForBit) {
  const Texture texture = random_texture(512, 1, 1);
  for (int i = -100; i <= 10100; ++i) {
    const float u = static_cast<float>(i) / 10000;
    EXPECT_EQ(sample(texture, u, 0.5F, Filter::linear)[0],
              brdf::listings::sample_linear(texture.texels, u, brdf::listings::Addressing::clamp));
  }
}

// A weight is off by at most 1/512, and is one of 257.
TEST(LutTexture, QuantisedWeightsAreMultiplesOf256thsNearTheExactOnes) {
  const Texture texture{.width = 2, .texels = {0, 1}};
  bool differs = false;
  for (int i = 0; i <= 10000; ++i) {
    const double u = 0.25 + 0.5 * i / 10000.0;
    const double exact = sample(texture, u, 0.5, Filter::linear)[0];
    const double rounded = sample(texture, u, 0.5, Filter::linear, Weights::quantised)[0];
    EXPECT_EQ(rounded * 256, std::round(rounded * 256));
    EXPECT_LE(std::abs(rounded - exact), 1.0 / 512);
    differs = differs || std::abs(rounded - exact) > 1.0 / 520;
  }
  EXPECT_TRUE(differs);
}

TEST(LutTexture, NoCoordinateLeadsOutOfTheTexture) {
  const Texture texture = random_texture(16, 16, 2);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (const float u : {-infinity, -3e38F, 0.0F, 1.0F, 3e38F, infinity, std::nanf("")}) {
    for (const Filter filter : {Filter::nearest, Filter::linear}) {
      for (const float value : sample(texture, u, u, filter)) EXPECT_LE(std::abs(value), 1);
    }
  }
}

}  // namespace
}  // namespace gonio::lut
