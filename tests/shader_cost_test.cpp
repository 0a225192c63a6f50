// bench/shader_cost: counting in a disassembly, how the shaders are put together, and what the
// counts of the listings and models have to be. Skipped where no Mesa is installed whose RADV
// compiles for chips; what another compiler may do otherwise is asked of one version only.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "bench/shader_cost_study.h"
#include "shader/chip_environment.h"
#include "shader/disassembly.h"
#include "shader/spirv.h"
#include "shader/vulkan_device.h"
#include "tests/run_program.h"

namespace gonio::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Disassembly, IsCountedByKind) {
  const shader::OperationCounts counts = shader::count_operations(
      "BB0:\n"
      "\ts_load_dwordx4 s[4:7], s[2:3], null                         ; f4080101 fa000000\n"
      "\ts_buffer_load_dwordx4 s[0:3], s[4:7], null                  ; f4280002 fa000000\n"
      "\tv_rsq_f32_e32 v1, v1                                        ; 7e025d01\n"
      "\tv_exp_f32_e32 v1, v1                                        ; 7e025d01\n"
      "\tv_mul_f32_e32 v0, v2, v0\n"
      "\n"
      "BB1:\n"
      "\timage_sample_lz v0, v[0:1], s[0:7], s[8:11] dmask:0x1 dim:SQ_RSRC_IMG_2D\n"
      "\ts_nop 0                                                     ; bf800000\n"
      "\t(then repeated 3 times)\n"
      "\texp mrt0 v3, v4, v0, v2 done                                ; f800080f 02000403\n"
      "\ts_endpgm");
  EXPECT_EQ(counts.instructions, 12);
  EXPECT_EQ(counts.transcendental, 2);
  EXPECT_EQ(counts.texture_reads, 1);
  EXPECT_EQ(counts.memory_loads, 2);
}

TEST(ShaderCost, ShadersCompileWhetherOrNotThereIsADriver) {
  for (const bench::CostedShader& shader : bench::costed_shaders()) {
    EXPECT_NO_THROW(shader::compile(shader.hlsl, shader::Language::hlsl, shader::Stage::fragment))
        << shader.subject << ", " << shader.path << '\n'
        << shader.hlsl;
  }
}

/// The version whose counts the page tells, and for which the exact counts hold.
constexpr std::string_view known_mesa = "Mesa 22.3.6";

/// Whether the Vulkan devices of this process are of that version: its drivers for CPU and GPU come
/// together.
bool is_known_mesa_installed() {
  try {
    const std::vector<shader::DeviceDescription> devices = shader::vulkan_devices();
    return std::any_of(devices.begin(), devices.end(), [](const auto& device) {
      return device.driver.find(known_mesa) != std::string::npos;
    });
  } catch (const shader::NoVulkanDevice&) {
    return false;
  }
}

/// The counts of two chips, of different generations.
class ShaderCostOnChips : public testing::Test {
 protected:
  void SetUp() override {
    if (shader::radv_manifests().empty()) {
      GTEST_SKIP() << "nothing compiles for GPU chips: no Mesa driver RADV (mesa-vulkan-drivers)";
    }
    const CommandResult result =
        run_program({GONIO_SHADER_COST, "--json", "--chip", "polaris10", "navi21"});
    if (result.exit_status == 3 && !is_known_mesa_installed()) {
      GTEST_SKIP() << "nothing compiles for GPU chips: " << result.err;
    }
    ASSERT_EQ(result.exit_status, 0) << result.err;
    chips_ = json::parse(result.out);
    ASSERT_EQ(chips_.size(), 2U);
  }

  const json& chips() const { return chips_; }

  std::string device() const { return chips_[0].at("device").get<std::string>(); }
  bool are_of_known_mesa() const { return device().find(known_mesa) != std::string::npos; }

  static json shader_of(const json& chip, std::string_view subject, std::string_view path,
                        std::string_view parameters) {
    for (const json& shader : chip.at("shaders")) {
      if (shader.at("subject") == subject && shader.at("path") == path &&
          shader.at("parameters") == parameters) {
        return shader;
      }
    }
    ADD_FAILURE() << "no " << subject << ", " << path << ", " << parameters;
    return {};
  }

  static int listing(const json& chip, std::string_view subject, std::string_view path,
                     std::string_view number) {
    return shader_of(chip, subject, path, "uniforms").at(std::string(number)).get<int>();
  }

 private:
  json chips_;
};

TEST_F(ShaderCostOnChips, AreOfTheChipsThatWereAskedFor) {
  EXPECT_THAT(chips()[0].at("device").get<std::string>(), HasSubstr("POLARIS10"));
  EXPECT_THAT(chips()[1].at("device").get<std::string>(), HasSubstr("NAVI21"));
}

TEST_F(ShaderCostOnChips, OnlyTablesReadATextureAndTheyReadOne) {
  for (const json& chip : chips()) {
    int tables = 0;
    for (const json& shader : chip.at("shaders")) {
      const auto path = shader.at("path").get<std::string>();
      const bool is_table = path == "512-texel table" || path.find(", cosine") != path.npos ||
                            path.find(", sqrt") != path.npos;
      tables += is_table ? 1 : 0;
      EXPECT_EQ(shader.at("texture_reads"), is_table ? 1 : 0) << shader;
    }
    EXPECT_GT(tables, 1);
  }
}

TEST_F(ShaderCostOnChips, TranscendentalOperationsAreThoseOfTheArithmetic) {
  if (!are_of_known_mesa()) {
    GTEST_SKIP() << "counted for " << known_mesa << "; here is " << device();
  }
  const std::string_view number = "transcendental";
  for (const json& chip : chips()) {
    // One root for each vector that is normalised.
    EXPECT_EQ(listing(chip, "interface", "n, l and v alone", number), 3);
    // Those, 1/x for each component of the factors A and B and for 1/max.
    EXPECT_EQ(listing(chip, "Oren-Nayar", "no normalise, no root", number), 3 + 2 + 1);
    // Those, two more normalisations and the root of both sines.
    EXPECT_EQ(listing(chip, "Oren-Nayar", "van Ouwerkerk's rewrite", number), 6 + 2 + 1);
    // n, l, v and h; 1/(n.h)^2, 1/r2 and one for the denominator; its root; exp.
    EXPECT_EQ(listing(chip, "Ward isotropic", "1/(n.h)^2 - 1", number), 4 + 3 + 1 + 1);
    // acos has a root at least; tan a sine, a cosine and a reciprocal for the one in 1/(n.h)^2.
    EXPECT_GE(listing(chip, "Ward isotropic", "tan(acos(n.h))", number), 9 + 3);
  }
}

TEST_F(ShaderCostOnChips, StableFormsTakeFewerTranscendentalOperationsThanTheNaiveOnes) {
  for (const json& chip : chips()) {
    EXPECT_LT(listing(chip, "Ward isotropic", "components of l + v", "transcendental"),
              listing(chip, "Ward isotropic", "tan(acos(n.h))", "transcendental"));
    EXPECT_LT(listing(chip, "lambert+ward", "analytic", "transcendental"),
              listing(chip, "Ward isotropic", "tan(acos(n.h))", "transcendental"));
    EXPECT_LT(listing(chip, "oren-nayar", "analytic", "transcendental"),
              listing(chip, "Oren-Nayar", "sin and tan of the angles", "transcendental"));
  }
}

TEST_F(ShaderCostOnChips, EveryShaderTakesMoreThanItsInterface) {
  for (const json& chip : chips()) {
    const int of_listings = listing(chip, "interface", "n, l and v alone", "instructions");
    const int of_models = shader_of(chip, "interface", "wi and wo alone", "").at("instructions");
    for (const json& shader : chip.at("shaders")) {
      if (shader.at("subject") == "interface") continue;
      const bool is_model =
          shader.at("path") == "analytic" || shader.at("parameters") == "literals";
      EXPECT_GT(shader.at("instructions"), is_model ? of_models : of_listings) << shader;
      EXPECT_GT(shader.at("estimated_latency"), 0) << shader;
      EXPECT_GT(shader.at("estimated_inverse_throughput"), 0) << shader;
      EXPECT_GT(shader.at("vector_registers"), 0) << shader;
      EXPECT_GT(shader.at("scalar_registers"), 0) << shader;
    }
  }
}

TEST_F(ShaderCostOnChips, LiteralsSpareInstructions) {
  for (const json& chip : chips()) {
    for (const json& shader : chip.at("shaders")) {
      if (shader.at("path") != "analytic" || shader.at("parameters") != "literals") continue;
      const auto subject = shader.at("subject").get<std::string>();
      EXPECT_LT(shader.at("instructions"), listing(chip, subject, "analytic", "instructions"));
      EXPECT_LT(shader.at("memory_loads"), listing(chip, subject, "analytic", "memory_loads"));
    }
  }
}

TEST_F(ShaderCostOnChips, StandBesideThePublishedFigures) {
  for (const json& chip : chips()) {
    std::multiset<int> published;
    for (const json& shader : chip.at("shaders")) {
      if (shader.contains("published_direct3d10")) {
        published.insert(shader.at("published_direct3d10").get<int>());
      }
    }
    EXPECT_EQ(published, (std::multiset<int>{33, 44, 46, 48, 71}));
  }
}

/// The cells of a line of a table of a page.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream parts(line);
  std::string part;
  std::getline(parts, part, '|');  // before the first stroke
  while (std::getline(parts, part, '|')) {
    const std::size_t first = part.find_first_not_of(' ');
    const std::size_t last = part.find_last_not_of(' ');
    cells.push_back(first == part.npos ? "" : part.substr(first, last - first + 1));
  }
  return cells;
}

/// What the page calls the numbers.
const std::map<std::string, std::string> columns_of_the_page{
    {"instr", "instructions"},
    {"transc", "transcendental"},
    {"latency", "estimated_latency"},
    {"busy", "estimated_inverse_throughput"}};

TEST_F(ShaderCostOnChips, AreWhatThePageSays) {
  if (!are_of_known_mesa()) {
    GTEST_SKIP() << "docs/shaders.md tells what " << known_mesa << " compiles; here is "
                 << device();
  }
  std::istringstream page(content_of(GONIO_SOURCE_DIR "/docs/shaders.md"));
  std::vector<std::string> columns;
  std::string subject;
  std::string line;
  int rows = 0;
  while (std::getline(page, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() > 2 && cells[1] == "path") columns = cells;
    const bool is_row = cells.size() == columns.size() && cells.size() > 2 && cells[1] != "path" &&
                        cells[0].find("---") == std::string::npos;
    if (!is_row) {
      if (cells.empty()) columns.clear();
      continue;
    }
    ++rows;
    if (!cells[0].empty()) subject = cells[0];
    const bool is_listing = columns[0] == "listing";
    const bool is_table = !is_listing && cells[1] != "analytic";
    for (std::size_t k = 2; k < cells.size(); ++k) {
      const auto number = columns_of_the_page.find(columns[k]);
      if (number == columns_of_the_page.end()) continue;
      const auto on = [&](const json& chip) {
        const std::string parameters = !is_listing ? "literals" : "uniforms";
        const std::string path = cells[1] + (is_table ? ", cosine" : "");
        return shader_of(chip, subject, path, parameters).at(number->second).get<int>();
      };
      EXPECT_EQ(cells[k], std::to_string(on(chips()[1])) + " / " + std::to_string(on(chips()[0])))
          << subject << ", " << cells[1] << ", " << columns[k];
    }
  }
  EXPECT_GT(rows, 20);
}

/// Whether a manifest lies where no variable of the environment can hide it.
bool is_driver_always_found() {
  return !shader::radv_manifests({"/etc/vulkan/icd.d", "/usr/local/etc/vulkan/icd.d"}).empty();
}

TEST(ShaderCostCommand, SaysWhatIsMissingWithoutTheDriver) {
  if (is_driver_always_found()) GTEST_SKIP() << "RADV's manifest is in /etc or /usr/local/etc";
  const TemporaryFolder empty;
  const std::string nowhere = empty / "none";
  const CommandResult result = run_program(
      {"/usr/bin/env", "HOME=" + nowhere, "XDG_DATA_DIRS=" + nowhere, "XDG_DATA_HOME=" + nowhere,
       "XDG_CONFIG_HOME=" + nowhere, "XDG_CONFIG_DIRS=" + nowhere, GONIO_SHADER_COST});
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("no Mesa driver RADV"));
  EXPECT_THAT(result.err, HasSubstr("mesa-vulkan-drivers"));
}

TEST(ShaderCostCommand, RefusesADriverThatIsNone) {
  const TemporaryFolder folder;
  const std::string manifest = folder.write("radeon_icd.json", "{}");
  const CommandResult result = run_program({GONIO_SHADER_COST, "--icd", manifest});
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("mesa-vulkan-drivers"));
}

TEST(ShaderCostCommand, RefusesAnotherDriver) {
  std::vector<std::string> manifests;
  for (const std::filesystem::path& folder : shader::driver_folders()) {
    const auto manifest = folder / "lvp_icd.x86_64.json";
    if (std::filesystem::exists(manifest)) manifests.push_back(manifest.string());
  }
  if (manifests.empty()) GTEST_SKIP() << "no driver lavapipe (lvp_icd.x86_64.json)";
  const CommandResult result = run_program({GONIO_SHADER_COST, "--icd", manifests.front()});
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("'llvmpipe"));
  EXPECT_THAT(result.err, HasSubstr("expected Mesa's driver RADV"));
}

/// The words of a command that runs with these variables and no others that choose a chip.
std::vector<std::string> in_environment(const std::vector<std::string>& variables,
                                        const std::vector<std::string>& command) {
  std::vector<std::string> words{"/usr/bin/env", "--unset=RADV_FORCE_FAMILY",
                                 "--unset=AMD_FORCE_FAMILY"};
  words.insert(words.end(), variables.begin(), variables.end());
  words.insert(words.end(), command.begin(), command.end());
  return words;
}

TEST(ShaderCostCommand, CountsOnNoOtherDeviceThanTheNullDeviceOfTheChip) {
  const std::vector<std::filesystem::path> manifests = shader::radv_manifests();
  if (manifests.empty()) GTEST_SKIP() << "no Mesa driver RADV (mesa-vulkan-drivers)";
  const auto expect_refused = [](const std::vector<std::string>& variables) {
    const CommandResult result =
        run_program(in_environment(variables, {GONIO_SHADER_COST, "--this-process", "polaris10"}));
    EXPECT_EQ(result.exit_status, 3) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr("no null device for 'polaris10'"));
  };
  std::vector<std::string> variables = shader::chip_environment("navi21", manifests);
  if (is_known_mesa_installed()) expect_refused(variables);  // others may have no null device
  // Without the variables RADV has the GPUs that are there, as versions without null device have.
  std::erase_if(variables, [](const std::string& variable) {
    return variable.find("_FORCE_FAMILY=") != std::string::npos;
  });
  expect_refused(variables);
}

TEST(ShaderCostCommand, RefusesAChipThatTheDriverDoesNotKnow) {
  if (shader::radv_manifests().empty()) GTEST_SKIP() << "no Mesa driver RADV (mesa-vulkan-drivers)";
  const CommandResult result = run_program({GONIO_SHADER_COST, "--chip", "abacus"});
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("nothing counted for 'abacus'"));
}

}  // namespace
}  // namespace gonio::tests
