// --device: what evaluates f_r, a Vulkan device or the CPU.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "shader/vulkan_device.h"

namespace gonio::app {

/// Adds --device to a command.
void add_device_option(CLI::App& command, std::string& name);

/// What is to be used, and in words what it is or why it is not there.
struct ChosenDevice {
  std::optional<shader::VulkanDevice> device;  // none: the CPU does the work
  std::string text;                            // "llvmpipe .. (CPU; driver ..; Vulkan 1.3.230)"
};

/// The best device without a name, or the CPU with the reason where there is none; the CPU for
/// `cpu`; else the device whose name contains it. Throws std::invalid_argument if none does,
/// shader::NoVulkanDevice, which offers `--device cpu`, if there is none at all.
ChosenDevice choose_device(const std::string& name);

}  // namespace gonio::app
