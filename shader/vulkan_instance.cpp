#include "shader/vulkan_instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace gonio::shader {
namespace {

/// What SPIR-V 1.3, the target of compile(), needs.
constexpr std::uint32_t least_api_version = VK_API_VERSION_1_1;
/// The newest of which anything here makes use, where a device has it (instruction_counts.cpp).
constexpr std::uint32_t newest_api_version = VK_API_VERSION_1_3;

vk::raii::Context open_loader() {
  try {
    return {};
  } catch (const std::runtime_error&) {
    throw NoVulkanDevice(
        "no Vulkan loader (libvulkan.so.1): install libvulkan1 and a driver such as "
        "mesa-vulkan-drivers");
  }
}

/// The loader and what it has found.
struct Vulkan {
  vk::raii::Context loader = open_loader();
  vk::raii::Instance instance = make_instance(loader);

  static vk::raii::Instance make_instance(const vk::raii::Context& loader) {
    const vk::ApplicationInfo application("gonio", 0, nullptr, 0, newest_api_version);
    try {
      return {loader, vk::InstanceCreateInfo({}, &application)};
    } catch (const vk::SystemError& error) {
      throw NoVulkanDevice(
          std::string("no Vulkan driver: install one, such as mesa-vulkan-drivers, or correct "
                      "VK_DRIVER_FILES and VK_ICD_FILENAMES if they are set (") +
          error.what() + ")");
    }
  }
};

/// The same for the whole process, to whose end it stays: Mesa's CPU driver loses memory each time
/// that it is unloaded.
const vk::raii::Instance& instance() {
  static const Vulkan* const vulkan = new Vulkan;
  return vulkan->instance;
}

DeviceType type_of(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return DeviceType::discrete_gpu;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return DeviceType::integrated_gpu;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return DeviceType::virtual_gpu;
    case vk::PhysicalDeviceType::eCpu:
      return DeviceType::cpu;
    default:
      return DeviceType::other;
  }
}

std::string version_text(std::uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
         std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

/// From the properties that came with Vulkan 1.2 and, before, with an extension.
std::string driver_of(const vk::raii::PhysicalDevice& device) {
  const bool is_told = device.getProperties().apiVersion >= VK_API_VERSION_1_2 ||
                       has_extension(device, VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME);
  if (!is_told) return {};
  const auto chain =
      device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
  const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
  const std::string name(driver.driverName.data());
  const std::string info(driver.driverInfo.data());
  return info.empty() ? name : name + ", " + info;
}

/// Those that can compute, the best first.
std::vector<vk::raii::PhysicalDevice> usable_devices() {
  std::vector<vk::raii::PhysicalDevice> usable;
  for (vk::raii::PhysicalDevice& device : all_devices()) {
    const vk::PhysicalDeviceProperties properties = device.getProperties();
    if (properties.apiVersion < least_api_version || is_null_device(properties) ||
        !queue_family(device)) {
      continue;
    }
    usable.push_back(std::move(device));
  }
  std::stable_sort(usable.begin(), usable.end(), [](const auto& a, const auto& b) {
    return type_of(a.getProperties().deviceType) < type_of(b.getProperties().deviceType);
  });
  return usable;
}

}  // namespace

std::vector<vk::raii::PhysicalDevice> all_devices() {
  try {
    return vk::raii::PhysicalDevices(instance());
  } catch (const vk::InitializationFailedError&) {
    return {};  // the loader holds it for an error that drivers have no hardware
  }
}

bool has_extension(const vk::raii::PhysicalDevice& device, std::string_view name) {
  const auto extensions = device.enumerateDeviceExtensionProperties();
  return std::any_of(extensions.begin(), extensions.end(), [&](const auto& extension) {
    return std::string_view(extension.extensionName) == name;
  });
}

bool is_null_device(const vk::PhysicalDeviceProperties& properties) {
  return std::string_view(properties.deviceName.data()).starts_with("Null hardware");
}

std::optional<std::uint32_t> queue_family(const vk::raii::PhysicalDevice& device) {
  const auto families = device.getQueueFamilyProperties();
  for (const vk::QueueFlags wanted : {vk::QueueFlagBits::eCompute | vk::QueueFlagBits::eGraphics,
                                      vk::QueueFlags(vk::QueueFlagBits::eCompute)}) {
    for (std::uint32_t f = 0; f < families.size(); ++f) {
      if ((families[f].queueFlags & wanted) == wanted) return f;
    }
  }
  return std::nullopt;
}

DeviceDescription describe(const vk::raii::PhysicalDevice& device) {
  const vk::PhysicalDeviceProperties properties = device.getProperties();
  return {std::string(properties.deviceName.data()), driver_of(device),
          type_of(properties.deviceType), version_text(properties.apiVersion)};
}

vk::raii::PhysicalDevice choose_device(std::string_view name) {
  std::vector<vk::raii::PhysicalDevice> devices = usable_devices();
  if (devices.empty()) {
    throw NoVulkanDevice(
        "no Vulkan device of version 1.1 that computes: install a driver for the GPU, or "
        "mesa-vulkan-drivers, which computes on the CPU");
  }
  std::string names;
  for (vk::raii::PhysicalDevice& device : devices) {
    const std::string found(device.getProperties().deviceName.data());
    if (found.find(name) != std::string::npos) return std::move(device);
    names += (names.empty() ? "'" : ", '") + found + "'";
  }
  throw std::invalid_argument("no Vulkan device's name contains '" + std::string(name) +
                              "'; there are " + names);
}

std::string_view name_of(DeviceType type) {
  switch (type) {
    case DeviceType::discrete_gpu:
      return "discrete GPU";
    case DeviceType::integrated_gpu:
      return "integrated GPU";
    case DeviceType::virtual_gpu:
      return "virtual GPU";
    case DeviceType::cpu:
      return "CPU";
    case DeviceType::other:
      break;
  }
  return "other";
}

std::string text_of(const DeviceDescription& device) {
  return fmt::format("{} ({}; driver {}; Vulkan {})", device.name, name_of(device.type),
                     device.driver.empty() ? "unknown" : device.driver, device.api_version);
}

std::vector<DeviceDescription> vulkan_devices() {
  std::vector<DeviceDescription> descriptions;
  for (const vk::raii::PhysicalDevice& device : usable_devices()) {
    descriptions.push_back(describe(device));
  }
  return descriptions;
}

}  // namespace gonio::shader
