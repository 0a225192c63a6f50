#include "shader/vulkan_memory.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace gonio::shader {

vk::raii::DeviceMemory allocate(const vk::raii::PhysicalDevice& physical,
                                const vk::raii::Device& device, const vk::MemoryRequirements& needs,
                                vk::MemoryPropertyFlags wanted) {
  const vk::PhysicalDeviceMemoryProperties memory = physical.getMemoryProperties();
  for (std::uint32_t type = 0; type < memory.memoryTypeCount; ++type) {
    const bool is_allowed = (needs.memoryTypeBits >> type & 1) != 0;
    const bool is_wanted = (memory.memoryTypes[type].propertyFlags & wanted) == wanted;
    if (is_allowed && is_wanted) return {device, vk::MemoryAllocateInfo(needs.size, type)};
  }
  throw std::runtime_error(
      "Vulkan device '" + std::string(physical.getProperties().deviceName.data()) +
      "' has no memory of the kind that Vulkan promises: " + vk::to_string(wanted));
}

SharedBuffer::SharedBuffer(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
                           std::size_t bytes, vk::BufferUsageFlags usage)
    : buffer_(device, vk::BufferCreateInfo({}, std::max(bytes, sizeof(float)), usage)),
      memory_(allocate(
          physical, device, buffer_.getMemoryRequirements(),
          vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent)) {
  buffer_.bindMemory(*memory_, 0);
  data_ = memory_.mapMemory(0, VK_WHOLE_SIZE);
}

}  // namespace gonio::shader
