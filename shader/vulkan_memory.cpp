#include "shader/vulkan_memory.h"

#include <algorithm>
#include <cstdint>

namespace gonio::shader {

vk::raii::DeviceMemory allocate(const vk::raii::PhysicalDevice& physical,
                                const vk::raii::Device& device, const vk::MemoryRequirements& needs,
                                vk::MemoryPropertyFlags wanted) {
  const vk::PhysicalDeviceMemoryProperties memory = physical.getMemoryProperties();
  std::uint32_t type = 0;
  while ((needs.memoryTypeBits >> type & 1) == 0 ||
         (memory.memoryTypes[type].propertyFlags & wanted) != wanted) {
    ++type;
  }
  return {device, vk::MemoryAllocateInfo(needs.size, type)};
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
