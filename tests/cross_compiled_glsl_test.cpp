// The two ways from the HLSL to GLSL, by the project's own translation (shader/glsl.h) and by
// glslang and SPIRV-Cross, compute the same when a device runs them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/typical_material.h"
#include "shader/compose.h"
#include "shader/spirv.h"
#include "tests/run_program.h"
#include "tests/vulkan_device_or_skip.h"

namespace gonio::tests {
namespace {

using shader::Language;

/// wi and wo of each pair, drawn over the hemisphere; every second wo about the mirror direction of
/// its wi, where the lobes are.
std::vector<float> drawn_pairs(std::size_t count) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  std::vector<float> components;
  const auto add = [&](double x, double y, double z) {
    const double length = std::sqrt(x * x + y * y + z * z);
    for (const double c : {x, y, std::abs(z)}) components.push_back(static_cast<float>(c / length));
  };
  for (std::size_t i = 0; i < count; ++i) {
    const double x = normal(generator);
    const double y = normal(generator);
    const double z = normal(generator);
    add(x, y, z);
    constexpr double near = 0.1;
    if (i % 2 == 0) {
      add(-x + near * normal(generator), -y + near * normal(generator), z);
    } else {
      add(normal(generator), normal(generator), normal(generator));
    }
  }
  return components;
}

/// GLSL 4.50 for Vulkan of the module.
std::string cross_compiled(const std::vector<std::uint32_t>& spirv) {
  const TemporaryFolder folder;
  const std::string module = folder / "module.spv";
  std::ofstream(module, std::ios::binary)
      .write(reinterpret_cast<const char*>(spirv.data()),
             static_cast<std::streamsize>(spirv.size() * sizeof(std::uint32_t)));
  const CommandResult result =
      run_program({GONIO_SPIRV_CROSS, module, "--version", "450", "--no-es", "--vulkan-semantics"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  return result.out;
}

class CrossCompiledGlsl : public testing::TestWithParam<const char*> {};

TEST_P(CrossCompiledGlsl, ComputesWhatTheTranslatedGlslComputes) {
  if (std::string_view(GONIO_SPIRV_CROSS).ends_with("NOTFOUND")) {
    GTEST_SKIP() << "nothing to compare with: no spirv-cross when the project was configured";
  }
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  constexpr std::uint32_t count = 10'000;
  constexpr std::size_t channels = 3;
  const brdf::BoundModel material = bench::typical_material(brdf::Model(GetParam()));
  const shader::SourceText text{.name = "both", .header = {}};
  const std::vector<float> pairs = drawn_pairs(count);
  const auto values_of = [&](const std::string& glsl) {
    return device.run(shader::compile(glsl, Language::glsl), pairs, channels * count, count);
  };

  const auto translated = values_of(evaluation_kernel(material, Language::glsl, text));
  const auto crossed = values_of(cross_compiled(
      shader::compile(evaluation_kernel(material, Language::hlsl, text), Language::hlsl)));

  const float peak = *std::max_element(translated.begin(), translated.end());
  ASSERT_GT(peak, 0);
  float largest = 0;
  for (std::size_t i = 0; i < translated.size(); ++i) {
    largest = std::max(largest, std::abs(crossed[i] - translated[i]));
  }
  // Both add and multiply the same numbers; what a compiler contracts or reorders moves a value by
  // a few roundings, of 6e-8 each.
  EXPECT_LE(largest, 5e-7F * peak);
}

INSTANTIATE_TEST_SUITE_P(Models, CrossCompiledGlsl,
                         testing::Values("lambert+ward-aniso", "ashikhmin-shirley-aniso", "strauss",
                                         "oren-nayar-full+blinn-phong"));

}  // namespace
}  // namespace gonio::tests
