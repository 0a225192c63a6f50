// A Vulkan device for a test, which is skipped, with the reason, where there is none.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

#include "shader/vulkan_device.h"

namespace gonio::tests {

/// The best device, or none and the reason why.
inline std::optional<shader::VulkanDevice> open_vulkan_device(std::string& reason) {
  try {
    return shader::VulkanDevice();
  } catch (const shader::NoVulkanDevice& error) {
    reason = error.what();
    return std::nullopt;
  }
}

}  // namespace gonio::tests

/// Declares `device`, a VulkanDevice, or skips the test.
#define GONIO_VULKAN_DEVICE_OR_SKIP(device)                                              \
  std::string device##_reason;                                                           \
  std::optional<::gonio::shader::VulkanDevice> device##_if_any =                         \
      ::gonio::tests::open_vulkan_device(device##_reason);                               \
  if (!device##_if_any) GTEST_SKIP() << "nothing runs the shaders: " << device##_reason; \
  ::gonio::shader::VulkanDevice device = std::move(*device##_if_any)
