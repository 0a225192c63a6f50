// Memory of a Vulkan device.
//
// For the .cpp files of this room only: those that include it need the headers of Vulkan.
#pragma once

#include <cstddef>
#include <vulkan/vulkan_raii.hpp>

namespace gonio::shader {

/// Memory for a buffer or an image, of a type that has all of `wanted`. Vulkan promises one that
/// both sides see coherently to every buffer, and one on the device to everything.
vk::raii::DeviceMemory allocate(const vk::raii::PhysicalDevice& physical,
                                const vk::raii::Device& device, const vk::MemoryRequirements& needs,
                                vk::MemoryPropertyFlags wanted);

/// Memory that both sides see, with a buffer over all of it.
class SharedBuffer {
 public:
  SharedBuffer(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
               std::size_t bytes, vk::BufferUsageFlags usage);

  vk::Buffer buffer() const { return *buffer_; }
  /// Where the program sees it.
  void* data() { return data_; }

 private:
  vk::raii::Buffer buffer_;
  vk::raii::DeviceMemory memory_;
  void* data_ = nullptr;
};

}  // namespace gonio::shader
