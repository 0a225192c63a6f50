#include "shader/vulkan_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace gonio::shader {
namespace {

using lut::Storage;

vk::Format format_of(const lut::Texture& texture) {
  const bool is_pair = texture.channels == 2;
  switch (texture.storage) {
    case Storage::r32f:
      return is_pair ? vk::Format::eR32G32Sfloat : vk::Format::eR32Sfloat;
    case Storage::r16f:
      return is_pair ? vk::Format::eR16G16Sfloat : vk::Format::eR16Sfloat;
    case Storage::unorm16:
      return is_pair ? vk::Format::eR16G16Unorm : vk::Format::eR16Unorm;
    case Storage::unorm8:
      break;
  }
  return is_pair ? vk::Format::eR8G8Unorm : vk::Format::eR8Unorm;
}

/// The bits of a number that a 16-bit float holds (IEEE 754 binary16).
std::uint16_t half_bits(float value) {
  constexpr float least_normal = 0x1p-14F;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000U;
  const float magnitude = std::abs(value);
  const std::uint32_t rest = magnitude < least_normal
                                 ? std::uint32_t(magnitude * 0x1p24F)
                                 : (std::bit_cast<std::uint32_t>(magnitude) - (112U << 23)) >> 13;
  return static_cast<std::uint16_t>(sign | rest);
}

/// Writes the number as a T to the place of that index.
template <class T>
void put(void* texels, std::size_t index, T value) {
  std::memcpy(static_cast<std::byte*>(texels) + index * sizeof(T), &value, sizeof(T));
}

void write_texels(const lut::Texture& texture, void* texels) {
  const std::vector<float>& values = texture.texels;
  for (std::size_t i = 0; i < values.size(); ++i) {
    switch (texture.storage) {
      case Storage::r32f:
        put(texels, i, values[i]);
        break;
      case Storage::r16f:
        put(texels, i, half_bits(values[i]));
        break;
      case Storage::unorm16:
        put(texels, i, static_cast<std::uint16_t>(std::lround(values[i] * 65535.F)));
        break;
      case Storage::unorm8:
        put(texels, i, static_cast<std::uint8_t>(std::lround(values[i] * 255.F)));
        break;
    }
  }
}

void check_size(const vk::raii::PhysicalDevice& physical, const lut::Texture& texture,
                const std::string& name) {
  const auto limit = physical.getProperties().limits.maxImageDimension2D;
  const auto larger = static_cast<std::uint32_t>(std::max(texture.width, texture.height));
  if (larger <= limit) return;
  throw std::invalid_argument(
      fmt::format("Vulkan device '{}': found a texture of {} x {} texels, expected at most {} each "
                  "way: take a smaller table, or the CPU",
                  name, texture.width, texture.height, limit));
}

void check_format(const vk::raii::PhysicalDevice& physical, const SampledTexture& sampled,
                  const std::string& name) {
  using Feature = vk::FormatFeatureFlagBits;
  const auto found = physical.getFormatProperties(format_of(sampled.texture)).optimalTilingFeatures;
  const std::string_view storage = lut::name_of(sampled.texture.storage);
  constexpr std::string_view what_to_do = "take a table of another format, or the CPU";
  const vk::FormatFeatureFlags needed = Feature::eSampledImage | Feature::eTransferDst;
  if ((found & needed) != needed) {
    throw std::runtime_error(fmt::format("Vulkan device '{}' has no textures of the format {}: {}",
                                         name, storage, what_to_do));
  }
  if (sampled.filter == lut::Filter::linear && !(found & Feature::eSampledImageFilterLinear)) {
    throw std::runtime_error(
        fmt::format("Vulkan device '{}' does not filter textures of the format {} linearly: {}, or "
                    "the nearest texel",
                    name, storage, what_to_do));
  }
}

/// The texture again, once the device is known to take it.
const lut::Texture& checked(const vk::raii::PhysicalDevice& physical, const SampledTexture& sampled,
                            const std::string& name) {
  check_size(physical, sampled.texture, name);
  check_format(physical, sampled, name);
  return sampled.texture;
}

vk::Extent3D extent_of(const lut::Texture& texture) {
  return {static_cast<std::uint32_t>(texture.width), static_cast<std::uint32_t>(texture.height), 1};
}

vk::raii::Image make_image(const vk::raii::Device& device, const lut::Texture& texture) {
  return {device, vk::ImageCreateInfo(
                      {}, vk::ImageType::e2D, format_of(texture), extent_of(texture), 1, 1,
                      vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                      vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst)};
}

constexpr vk::ImageSubresourceRange whole(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1);

vk::raii::ImageView make_view(const vk::raii::Device& device, const vk::raii::Image& image,
                              const vk::raii::DeviceMemory& memory, vk::Format format) {
  image.bindMemory(*memory, 0);
  return {device, vk::ImageViewCreateInfo({}, *image, vk::ImageViewType::e2D, format, {}, whole)};
}

vk::raii::Sampler make_sampler(const vk::raii::Device& device, lut::Filter filter) {
  const auto of_device = filter == lut::Filter::linear ? vk::Filter::eLinear : vk::Filter::eNearest;
  constexpr auto clamp = vk::SamplerAddressMode::eClampToEdge;
  return {device, vk::SamplerCreateInfo({}, of_device, of_device, vk::SamplerMipmapMode::eNearest,
                                        clamp, clamp, clamp)};
}

}  // namespace

VulkanTexture::VulkanTexture(const vk::raii::PhysicalDevice& physical,
                             const vk::raii::Device& device, const SampledTexture& texture,
                             const std::string& name)
    : extent_(extent_of(checked(physical, texture, name))),
      staging_(physical, device, lut::bytes_of(texture.texture),
               vk::BufferUsageFlagBits::eTransferSrc),
      image_(make_image(device, texture.texture)),
      memory_(allocate(physical, device, image_.getMemoryRequirements(),
                       vk::MemoryPropertyFlagBits::eDeviceLocal)),
      view_(make_view(device, image_, memory_, format_of(texture.texture))),
      sampler_(make_sampler(device, texture.filter)) {
  write_texels(texture.texture, staging_.data());
}

void VulkanTexture::record_upload(const vk::raii::CommandBuffer& commands) const {
  using Layout = vk::ImageLayout;
  using Stage = vk::PipelineStageFlagBits;
  constexpr std::uint32_t same_queue = VK_QUEUE_FAMILY_IGNORED;
  const vk::ImageMemoryBarrier made({}, vk::AccessFlagBits::eTransferWrite, Layout::eUndefined,
                                    Layout::eTransferDstOptimal, same_queue, same_queue, *image_,
                                    whole);
  commands.pipelineBarrier(Stage::eTopOfPipe, Stage::eTransfer, {}, {}, {}, made);
  const vk::BufferImageCopy all(0, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, 1}, {}, extent_);
  commands.copyBufferToImage(staging_.buffer(), *image_, Layout::eTransferDstOptimal, all);
  const vk::ImageMemoryBarrier filled(vk::AccessFlagBits::eTransferWrite,
                                      vk::AccessFlagBits::eShaderRead, Layout::eTransferDstOptimal,
                                      Layout::eShaderReadOnlyOptimal, same_queue, same_queue,
                                      *image_, whole);
  commands.pipelineBarrier(Stage::eTransfer, Stage::eComputeShader, {}, {}, {}, filled);
}

}  // namespace gonio::shader
