// shader_cost: what the pixel shaders of every model cost on GPU chips that need not be there:
// instructions, transcendental and memory operations, registers, and the compiler's estimates of
// latency and throughput, beside the instruction counts published for Direct3D 10.
//
// It runs itself once for each chip, because a process has one (shader/instruction_counts.h).
//
// Exit status: 0 counted; 2 wrong usage; 3 no Mesa driver RADV, or one that has no null device or
// does not compile for the chip.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/own_process.h"
#include "bench/shader_cost_report.h"
#include "bench/shader_cost_study.h"
#include "bench/study_main.h"
#include "shader/chip_environment.h"

namespace gonio::bench {
namespace {

constexpr int nothing_counted = 3;  // as study_main() exits for NoChipCompiler

struct Settings {
  std::vector<std::string> chips{"polaris10", "navi21"};
  std::vector<std::filesystem::path> manifests;
  bool json = false;
  std::string own_chip;  // of this process; it is one that another has started
};

std::vector<std::filesystem::path> manifests_of(const Settings& settings) {
  auto manifests = settings.manifests.empty() ? shader::radv_manifests() : settings.manifests;
  if (manifests.empty()) {
    throw shader::NoChipCompiler(
        "no Mesa driver RADV (radeon_icd*.json in the folders of Vulkan drivers): install "
        "mesa-vulkan-drivers, or give its manifest with --icd");
  }
  return manifests;
}

/// What a process of its own prints for the chip, or nothing if it has said why it cannot.
std::optional<std::string> counted(const std::string& chip, const Settings& settings) {
  std::vector<std::string> arguments{"--this-process", chip};
  if (settings.json) arguments.emplace_back("--json");
  const ProcessResult result =
      run_own_process(arguments, shader::chip_environment(chip, manifests_of(settings)));
  if (result.exit_status == 0) return result.out;
  if (result.exit_status == nothing_counted) return std::nullopt;
  throw shader::NoChipCompiler(
      fmt::format("nothing counted for '{}': RADV ended the process, as it does for a chip that it "
                  "does not know, and in versions of Mesa that know none (26.2 and later)",
                  chip));
}

int count_in_this_process(const Settings& settings) {
  try {
    const ChipCosts costs = shader_costs(settings.own_chip);
    fmt::print("{}", settings.json ? shader_cost_json(settings.own_chip, costs)
                                   : shader_cost_table(settings.own_chip, costs));
    return 0;
  } catch (const shader::NoChipCompiler& error) {
    throw shader::NoChipCompiler(
        fmt::format("nothing counted for '{}': {}", settings.own_chip, error.what()));
  }
}

int count(const Settings& settings) {
  std::string text;
  for (const std::string& chip : settings.chips) {
    const std::optional<std::string> part = counted(chip, settings);
    if (!part) return nothing_counted;
    if (settings.json) text += text.empty() ? "" : ",\n";
    text += *part;
  }
  fmt::print("{}", settings.json ? fmt::format("[{}]\n", text) : shader_cost_preface() + text);
  return 0;
}

int run(int argc, char** argv) {
  Settings settings;
  CLI::App app{
      "Counts the instructions of every model's pixel shader on GPU chips that need not be there:\n"
      "Mesa's driver RADV compiles for them."};
  app.name("shader_cost");
  app.add_option("--chip", settings.chips, "Chips as RADV calls them: polaris10, vega10, navi21 ..")
      ->capture_default_str();
  app.add_option("--icd", settings.manifests, "RADV's manifest; found by itself without")
      ->check(CLI::ExistingFile);
  app.add_flag("--json", settings.json, "As JSON: an array with an object for each chip");
  app.add_option("--this-process", settings.own_chip)->group("");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "shader_cost: {} (--help says what there is)\n", error.what());
    return 2;
  }
  return settings.own_chip.empty() ? count(settings) : count_in_this_process(settings);
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("shader_cost", gonio::bench::run, argc, argv);
}
