#include "apps/gonio/device_option.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "shader/evaluate.h"

namespace gonio::app {
namespace {

constexpr std::string_view cpu = "cpu";

/// Throws std::runtime_error if the device does not compute what it should: some drivers only
/// pretend to.
void require_right(shader::VulkanDevice& device) {
  const std::vector<double> rho_d{0.5};
  const std::vector<brdf::NamedValues> parameters{{"rho_d", rho_d}};
  const brdf::BoundModel half_white(brdf::Model("lambert"), 1, parameters);
  const brdf::Direction<float> up{0, 0, 1};
  const std::vector<brdf::DirectionPair<float>> pairs{{up, up}};
  const float expected = 0.5F * std::numbers::inv_pi_v<float>;
  const float found = shader::evaluate(device, half_white, pairs).front();
  if (std::abs(found - expected) <= 1e-5F * expected) return;
  throw std::runtime_error(fmt::format(
      "Vulkan device '{}' computes wrongly: for a matt surface it found an f_r of {:g}, "
      "expected {:g}",
      device.description().name, found, expected));
}

}  // namespace

void add_device_option(CLI::App& command, std::string& name) {
  command
      .add_option("--device", name,
                  "What evaluates: a part of a Vulkan device's name, or cpu; without it the best "
                  "device there is, or the CPU")
      ->type_name("NAME");
}

ChosenDevice choose_device(const std::string& name) {
  if (name == cpu) return {std::nullopt, "the CPU, as asked"};
  try {
    shader::VulkanDevice device(name);
    require_right(device);
    std::string text = shader::text_of(device.description());
    return {std::move(device), std::move(text)};
  } catch (const shader::NoVulkanDevice& error) {
    if (name.empty()) return {std::nullopt, fmt::format("the CPU: {}", error.what())};
    throw shader::NoVulkanDevice(
        fmt::format("--device {}: {}; or take --device cpu", name, error.what()));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        fmt::format("--device {}: {}; or take --device cpu", name, error.what()));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}; take --device cpu, or another one", error.what()));
  }
}

}  // namespace gonio::app
