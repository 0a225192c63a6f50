// A texture on a Vulkan device, with the sampler that reads it.
//
// For the .cpp files of this room only: those that include it need the headers of Vulkan.
#pragma once

#include <string>
#include <vulkan/vulkan_raii.hpp>

#include "shader/vulkan_device.h"
#include "shader/vulkan_memory.h"

namespace gonio::shader {

class VulkanTexture {
 public:
  /// Makes the image; record_upload() fills it. `name` is the device's, for messages. Throws
  /// std::invalid_argument if the texture is larger than the device takes, std::runtime_error if
  /// the device does not sample its format with that filter.
  VulkanTexture(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
                const SampledTexture& texture, const std::string& name);

  /// Copies the texels to the image, for the compute shaders that come after it.
  void record_upload(const vk::raii::CommandBuffer& commands) const;

  vk::DescriptorImageInfo image_info() const {
    return {{}, *view_, vk::ImageLayout::eShaderReadOnlyOptimal};
  }
  vk::DescriptorImageInfo sampler_info() const { return {*sampler_, {}, {}}; }

 private:
  vk::Extent3D extent_;
  SharedBuffer staging_;
  vk::raii::Image image_;
  vk::raii::DeviceMemory memory_;
  vk::raii::ImageView view_;
  vk::raii::Sampler sampler_;
};

}  // namespace gonio::shader
