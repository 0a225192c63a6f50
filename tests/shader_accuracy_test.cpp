// Exported shader functions, run on a Vulkan device, against the models in double: the short form
// of bench/shader_accuracy, and directions where a float's arithmetic ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "bench/shader_accuracy_study.h"
#include "shader/evaluate.h"
#include "tests/vulkan_device_or_skip.h"

namespace gonio {
namespace {

using bench::DirectionPair;
using bench::LobeWidths;
using bench::ShaderAccuracySettings;
using bench::ShaderErrors;
using bench::ShaderMaterial;

constexpr ShaderAccuracySettings short_form{.pairs = 5000};

std::string text_of(const ShaderErrors& errors) {
  const auto& [wi, wo] = errors.worst.pair;
  std::string text = errors.language == shader::Language::hlsl ? "hlsl " : "glsl ";
  text += errors.model + " " + errors.parameters;
  for (const float component : {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z}) {
    text += " " + std::to_string(component);
  }
  return text;
}

std::string name_of(const brdf::Model& model) {
  std::string name = model.name() + (model.has_free_frame() ? "_free_frame" : "");
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '-' || c == '+'; }, '_');
  return name;
}

struct Tested {
  brdf::Model model;
};

void PrintTo(const Tested& tested,  // NOLINT(readability-identifier-naming): gtest's
             std::ostream* stream) {
  *stream << name_of(tested.model);
}

std::vector<Tested> every_model() {
  std::vector<Tested> all;
  for (brdf::Model& model : bench::shader_models()) all.push_back({std::move(model)});
  return all;
}

class EveryShader : public testing::TestWithParam<Tested> {
 protected:
  static std::vector<ShaderMaterial> materials(LobeWidths widths) {
    return bench::shader_materials(GetParam().model, widths);
  }
};
INSTANTIATE_TEST_SUITE_P(Of, EveryShader, testing::ValuesIn(every_model()),
                         [](const auto& tested) { return name_of(tested.param.model); });

TEST_P(EveryShader, IsTheModelToTheFigureOfThePeak) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  ASSERT_FALSE(materials(LobeWidths::ordinary).empty());
  for (const ShaderMaterial& material : materials(LobeWidths::ordinary)) {
    for (const ShaderErrors& errors : bench::shader_errors(material, short_form, device)) {
      SCOPED_TRACE(text_of(errors));
      EXPECT_LE(errors.worst.error, 2e-5);  // the figure: of the lobe's peak
      EXPECT_EQ(errors.not_finite, 0U);
      EXPECT_EQ(errors.lit_below_horizon, 0U);
      // A shader that agrees to the last digit of double was not run in float.
      EXPECT_GT(errors.worst.error, 1e-12);
    }
  }
}

TEST_P(EveryShader, OfANarrowLobeErrsNoMoreThanTheDirectionsDo) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  for (const ShaderMaterial& material : materials(LobeWidths::narrow)) {
    for (const ShaderErrors& errors : bench::shader_errors(material, short_form, device)) {
      SCOPED_TRACE(text_of(errors));
      EXPECT_LE(errors.worst.error, 2e-5);  // docs/shaders.md: the bound does not depend on alpha
      EXPECT_EQ(errors.not_finite, 0U);
      EXPECT_LE(errors.input_rounding, errors.input_rounding_bound);
      // A bound that is far from what is met would say nothing.
      EXPECT_GE(errors.input_rounding, errors.input_rounding_bound / 20);
    }
  }
}

/// Directions at the normal, at the horizon and as near it as float can be, and below it.
std::vector<brdf::Direction<float>> edge_directions() {
  constexpr float smallest = std::numeric_limits<float>::min();
  constexpr float denormal = std::numeric_limits<float>::denorm_min();
  std::vector<brdf::Direction<float>> directions{{0, 0, 1}, {1e-20F, 0, 1}, {0, denormal, 1}};
  for (const float z :
       {1e-3F, 1e-6F, 1e-12F, 1e-30F, smallest, denormal, 0.F, -0.F, -denormal, -1e-6F, -1.F}) {
    const float sine = std::sqrt((1 - z) * (1 + z));
    directions.insert(directions.end(), {{sine, 0, z},
                                         {-sine, 0, z},
                                         {0, sine, z},
                                         {0.6F * sine, -0.8F * sine, z},
                                         {-0.6F * sine, 0.8F * sine, z}});
  }
  return directions;
}

std::vector<DirectionPair<float>> all_pairs(const std::vector<brdf::Direction<float>>& directions) {
  std::vector<DirectionPair<float>> pairs;
  for (const auto& wi : directions) {
    for (const auto& wo : directions) pairs.push_back({wi, wo});
  }
  return pairs;
}

TEST_P(EveryShader, IsFiniteAtTheEdgesAndZeroBelowTheHorizon) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const auto pairs = all_pairs(edge_directions());
  for (const LobeWidths widths : {LobeWidths::ordinary, LobeWidths::narrow}) {
    for (const ShaderMaterial& material : materials(widths)) {
      for (const shader::Language language : {shader::Language::hlsl, shader::Language::glsl}) {
        const auto values = shader::evaluate(device, material.bound, pairs, language);
        std::size_t lit = 0;
        for (std::size_t k = 0; k < values.size(); ++k) {
          const auto& [wi, wo] = pairs[k / material.bound.channel_count()];
          ASSERT_TRUE(std::isfinite(values[k]) && values[k] >= 0)
              << material.model << " " << material.parameters << ": " << values[k] << " at " << wi.x
              << " " << wi.y << " " << wi.z << ", " << wo.x << " " << wo.y << " " << wo.z;
          if (!(wi.z > 0 && wo.z > 0)) {
            ASSERT_EQ(values[k], 0);
          }
          if (values[k] > 0) ++lit;
        }
        EXPECT_GT(lit, 0U) << material.model << " " << material.parameters;
      }
    }
  }
}

}  // namespace
}  // namespace gonio
