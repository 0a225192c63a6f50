// shader_accuracy: how far the exported HLSL and GLSL functions are from the models when a Vulkan
// device runs them. Every model with several parameters, then lobes narrower than the figure is
// for.
//
// Exit status: 0 every figure reached; 1 not; 2 wrong usage; 3 no Vulkan device, or one that
// failed.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "bench/shader_accuracy_report.h"
#include "bench/shader_accuracy_study.h"
#include "bench/study_main.h"

namespace gonio::bench {
namespace {

int list_devices() {
  const std::vector<shader::DeviceDescription> devices = shader::vulkan_devices();
  for (const auto& device : devices) fmt::print("{}\n", shader::text_of(device));
  if (devices.empty()) fmt::print(stderr, "shader_accuracy: no Vulkan device that computes\n");
  return devices.empty() ? 3 : 0;
}

int study(const ShaderAccuracySettings& settings, const std::string& device_name) {
  shader::VulkanDevice device(device_name);
  fmt::print("device: {}\n{} pairs of directions for each material; errors as fractions\n\n",
             shader::text_of(device.description()), settings.pairs);
  const auto ordinary = shader_accuracy(LobeWidths::ordinary, settings, device);
  fmt::print("alpha >= 1e-2, exponents <= 1e4: the figure is {:g}\n{}\n", shader_figure,
             shader_error_table(ordinary));
  const auto narrow = shader_accuracy(LobeWidths::narrow, settings, device);
  fmt::print(
      "narrower lobes; 'directions': what rounding the directions to float changes, which no\n"
      "function of them can help\n{}",
      narrow_lobe_table(narrow));
  const bool all_hold = std::all_of(ordinary.begin(), ordinary.end(), figure_holds) &&
                        std::all_of(narrow.begin(), narrow.end(), figure_holds);
  return all_hold ? 0 : 1;
}

int run(int argc, char** argv) {
  ShaderAccuracySettings settings;
  std::string device;
  bool only_list = false;
  CLI::App app{
      "Runs the exported shader function of every model on a Vulkan device and compares it with\n"
      "the model in double."};
  app.name("shader_accuracy");
  app.add_option("--pairs", settings.pairs, "Pairs of directions for each material")
      ->check(CLI::Range(std::size_t(100), std::size_t(10'000'000)))
      ->capture_default_str();
  app.add_option("--seed", settings.seed, "Of the random draws")->capture_default_str();
  app.add_option("--device", device, "A part of the device's name; the best device without");
  app.add_flag("--list", only_list, "List the devices instead");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "shader_accuracy: {} (--help says what there is)\n", error.what());
    return 2;
  }
  return only_list ? list_devices() : study(settings, device);
}

}  // namespace
}  // namespace gonio::bench

int main(int argc, char** argv) {
  return gonio::bench::study_main("shader_accuracy", gonio::bench::run, argc, argv);
}
