// Compiling shader text and running it: what the tests of exported shaders stand on.
#include "shader/vulkan_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <spirv-tools/libspirv.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "shader/spirv.h"
#include "tests/vulkan_device_or_skip.h"

namespace gonio {
namespace {

using shader::Language;
using shader::VulkanDevice;

// Each element is two numbers; the result is their product, and a second number that nobody writes.
constexpr const char* products_glsl = R"(#version 450
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Input { float numbers[]; };
layout(std430, binding = 1) writeonly buffer Output { float products[]; };
layout(push_constant) uniform Elements { uint count; } elements;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < elements.count) products[2u * i] = numbers[2u * i] * numbers[2u * i + 1u];
})";

constexpr const char* products_hlsl = R"(
[[vk::binding(0)]] StructuredBuffer<float> numbers;
[[vk::binding(1)]] RWStructuredBuffer<float> products;
struct Elements { uint count; };
[[vk::push_constant]] Elements elements;
[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
  if (id.x < elements.count) products[2 * id.x] = numbers[2 * id.x] * numbers[2 * id.x + 1];
})";

// out = in + 1, one number each.
constexpr const char* successors_glsl = R"(#version 450
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Input { float numbers[]; };
layout(std430, binding = 1) writeonly buffer Output { float successors[]; };
layout(push_constant) uniform Elements { uint count; } elements;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < elements.count) successors[i] = numbers[i] + 1.0;
})";

const char* products_in(Language language) {
  return language == Language::hlsl ? products_hlsl : products_glsl;
}

std::string refusal(const std::string& source, Language language) {
  try {
    shader::compile(source, language);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

class EveryLanguage : public testing::TestWithParam<Language> {};
INSTANTIATE_TEST_SUITE_P(Spirv, EveryLanguage, testing::Values(Language::hlsl, Language::glsl),
                         [](const auto& tested) {
                           return tested.param == Language::hlsl ? "hlsl" : "glsl";
                         });

TEST_P(EveryLanguage, CompilesToAModuleThatTheSpirvToolsAccept) {
  const std::vector<std::uint32_t> words = shader::compile(products_in(GetParam()), GetParam());
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
  std::string messages;
  tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&,
                               const char* message) { messages += message; });
  EXPECT_TRUE(tools.Validate(words)) << messages;
}

TEST_P(EveryLanguage, ARefusalIsOneLineThatNamesWhatIsWrong) {
  std::string source = products_in(GetParam());
  source.replace(source.rfind("numbers"), 7, "letters");
  const std::string message = refusal(source, GetParam());
  EXPECT_THAT(message, testing::StartsWith(GetParam() == Language::hlsl ? "HLSL shader: "
                                                                        : "GLSL shader: "));
  EXPECT_THAT(message, testing::HasSubstr("letters"));
  EXPECT_THAT(message, testing::Not(testing::HasSubstr("\n")));
}

TEST_P(EveryLanguage, ATextWithoutMainIsRefused) {
  const std::string functions = GetParam() == Language::hlsl
                                    ? "float one() { return 1.0; }"
                                    : "#version 450\nfloat one() { return 1.0; }";
  EXPECT_NE(refusal(functions, GetParam()), "");
}

TEST_P(EveryLanguage, ThreadsCompileAtOnce) {
  const auto alone = shader::compile(products_in(GetParam()), GetParam());
  std::vector<std::vector<std::uint32_t>> found(4);
  std::vector<std::thread> threads;
  for (auto& words : found) {
    threads.emplace_back([&] { words = shader::compile(products_in(GetParam()), GetParam()); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(found, testing::Each(alone));
}

TEST_P(EveryLanguage, EveryElementGetsItsShareAndTheRestStaysZero) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  constexpr std::size_t count = 1000;  // not a multiple of the group's 64
  std::vector<float> numbers(2 * count);
  std::iota(numbers.begin(), numbers.end(), 0.1F);
  const auto found =
      device.run(shader::compile(products_in(GetParam()), GetParam()), numbers, 2 * count, count);
  ASSERT_EQ(found.size(), 2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    // Vulkan asks for correct rounding of products.
    EXPECT_EQ(found[2 * i], numbers[2 * i] * numbers[2 * i + 1]) << i;
    EXPECT_EQ(found[2 * i + 1], 0) << i;
  }
}

TEST(VulkanDevice, DoesMoreElementsThanOneDispatchTakes) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  // Every device takes 65535 groups of 64, many no more. All numbers are exact in float.
  constexpr std::uint32_t count = 65535 * 64 + 4321;
  std::vector<float> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0.F);
  const auto found =
      device.run(shader::compile(successors_glsl, Language::glsl), numbers, count, count);
  std::vector<float> expected(count);
  std::iota(expected.begin(), expected.end(), 1.F);
  EXPECT_TRUE(found == expected);
}

TEST(VulkanDevice, RunsAgainAfterARunAndAMove) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const auto spirv = shader::compile(successors_glsl, Language::glsl);
  const std::vector<float> numbers{1, 2, 3};
  EXPECT_THAT(device.run(spirv, numbers, 3, 3), testing::ElementsAre(2, 3, 4));
  VulkanDevice moved(std::move(device));
  EXPECT_THAT(moved.run(spirv, numbers, 3, 3), testing::ElementsAre(2, 3, 4));
  EXPECT_THAT(moved.run(spirv, {}, 2, 0), testing::ElementsAre(0, 0));
}

TEST(VulkanDevice, RefusesSizesThatAreNoMultiplesOfTheCount) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const auto spirv = shader::compile(successors_glsl, Language::glsl);
  const std::vector<float> numbers(7);
  EXPECT_THROW(device.run(spirv, numbers, 6, 3), std::invalid_argument);
  EXPECT_THROW(device.run(spirv, numbers, 13, 7), std::invalid_argument);
}

TEST(VulkanDevice, IsTheBestOfTheListAndOpensByAPartOfItsName) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const auto devices = shader::vulkan_devices();
  ASSERT_FALSE(devices.empty());
  EXPECT_EQ(device.description().name, devices.front().name);
  EXPECT_TRUE(std::is_sorted(devices.begin(), devices.end(),
                             [](const auto& a, const auto& b) { return a.type < b.type; }));
  for (const auto& description : devices) {
    EXPECT_THAT(description.api_version, testing::MatchesRegex("1\\.[0-9]+\\.[0-9]+"));
    const std::string part = description.name.substr(1);
    EXPECT_THAT(VulkanDevice(part).description().name, testing::HasSubstr(part));
  }
}

TEST(VulkanDevice, OfAnUnknownNameIsRefusedWithTheNamesThereAre) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  try {
    const VulkanDevice unknown("no such device");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'no such device'"));
    EXPECT_THAT(error.what(), testing::HasSubstr("'" + device.description().name + "'"));
  }
}

/// Opens a device and ends the process: with 3 and the message if there is none.
[[noreturn]] void open_and_exit() {
  try {
    const VulkanDevice device;
    std::exit(0);
  } catch (const shader::NoVulkanDevice& error) {
    std::fputs(error.what(), stderr);
    std::exit(3);
  }
}

/// Sets an environment variable for the test, and for the processes that it starts.
class Variable {
 public:
  Variable(std::string name, const std::string& value) : name_(std::move(name)) {
    if (const char* before = std::getenv(name_.c_str())) before_ = before;
    setenv(name_.c_str(), value.c_str(), 1);
  }
  ~Variable() {
    if (before_) {
      setenv(name_.c_str(), before_->c_str(), 1);
    } else {
      unsetenv(name_.c_str());
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  std::string name_;
  std::optional<std::string> before_;
};

// Each opens the device in a process of its own, which has not found the loader yet.
class NoVulkanDeathTest : public testing::Test {
 protected:
  NoVulkanDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(NoVulkanDeathTest, WithoutADriverTheMessageSaysWhatToInstall) {
  const Variable files("VK_DRIVER_FILES", "/nowhere.json");
  const Variable older_name("VK_ICD_FILENAMES", "/nowhere.json");
  EXPECT_EXIT(open_and_exit(), testing::ExitedWithCode(3),
              "^no Vulkan (driver|loader).*: install .*mesa-vulkan-drivers");
}

TEST_F(NoVulkanDeathTest, WithoutALoaderTheMessageSaysWhatToInstall) {
  // What the process finds first under the loader's names is no library.
  const auto folder = std::filesystem::path(testing::TempDir()) / "gonio_no_vulkan";
  std::filesystem::create_directories(folder);
  for (const char* name : {"libvulkan.so", "libvulkan.so.1"}) {
    std::ofstream(folder / name) << "no library";
  }
  const Variable path("LD_LIBRARY_PATH", folder.string());
  EXPECT_EXIT(open_and_exit(), testing::ExitedWithCode(3),
              "^no Vulkan loader \\(libvulkan.so.1\\): install libvulkan1");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace gonio
