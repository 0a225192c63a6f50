#include "apps/gonio/device_option.h"

#include <fmt/format.h>

#include <stdexcept>

namespace gonio::app {
namespace {

constexpr std::string_view cpu = "cpu";

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
