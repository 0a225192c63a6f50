// The Vulkan loader, opened once for the process, and the devices that it knows.
//
// For the .cpp files of this room only: those that include it need the headers of Vulkan.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "shader/vulkan_device.h"

namespace gonio::shader {

/// Every device of every driver, of whatever version. Throws NoVulkanDevice if there is no loader
/// or no driver.
std::vector<vk::raii::PhysicalDevice> all_devices();

bool has_extension(const vk::raii::PhysicalDevice& device, std::string_view name);

/// What Mesa's RADV offers for a chip that is not there (chip_environment.h): it compiles for the
/// chip, and waits for ever for what nothing computes.
bool is_null_device(const vk::PhysicalDeviceProperties& properties);

/// A queue family of the device that computes, if there is one: rather one that draws as well.
std::optional<std::uint32_t> queue_family(const vk::raii::PhysicalDevice& device);

DeviceDescription describe(const vk::raii::PhysicalDevice& device);

/// The best device of Vulkan 1.1 that computes and whose name contains `name`. Throws
/// NoVulkanDevice if there is no device, std::invalid_argument with the names if none is meant.
vk::raii::PhysicalDevice choose_device(std::string_view name);

}  // namespace gonio::shader
