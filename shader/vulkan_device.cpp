#include "shader/vulkan_device.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "shader/vulkan_instance.h"
#include "shader/vulkan_memory.h"
#include "shader/vulkan_texture.h"

namespace gonio::shader {
namespace {

constexpr std::uint32_t local_size = 64;

/// What is bound at 0, 1, ..: the two buffers, and with a texture its image and its sampler.
std::vector<vk::DescriptorType> bound_types(bool with_texture) {
  std::vector types{vk::DescriptorType::eStorageBuffer, vk::DescriptorType::eStorageBuffer};
  if (with_texture) {
    types.push_back(vk::DescriptorType::eSampledImage);
    types.push_back(vk::DescriptorType::eSampler);
  }
  return types;
}

vk::raii::DescriptorSetLayout make_set_layout(const vk::raii::Device& device,
                                              const std::vector<vk::DescriptorType>& types) {
  std::vector<vk::DescriptorSetLayoutBinding> bindings;
  for (const vk::DescriptorType type : types) {
    bindings.emplace_back(static_cast<std::uint32_t>(bindings.size()), type, 1,
                          vk::ShaderStageFlagBits::eCompute);
  }
  return {device, vk::DescriptorSetLayoutCreateInfo({}, bindings)};
}

vk::raii::PipelineLayout make_layout(const vk::raii::Device& device,
                                     const vk::raii::DescriptorSetLayout& set_layout) {
  const vk::PushConstantRange count(vk::ShaderStageFlagBits::eCompute, 0, sizeof(std::uint32_t));
  return {device, vk::PipelineLayoutCreateInfo({}, *set_layout, count)};
}

vk::raii::Pipeline make_pipeline(const vk::raii::Device& device,
                                 const vk::raii::PipelineLayout& layout,
                                 std::span<const std::uint32_t> spirv) {
  const vk::raii::ShaderModule module(
      device, vk::ShaderModuleCreateInfo({}, spirv.size_bytes(), spirv.data()));
  const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module,
                                                "main");
  return {device, nullptr, vk::ComputePipelineCreateInfo({}, stage, *layout)};
}

/// For one set.
vk::raii::DescriptorPool make_pool(const vk::raii::Device& device,
                                   const std::vector<vk::DescriptorType>& types) {
  std::vector<vk::DescriptorPoolSize> sizes;
  for (const vk::DescriptorType type : types) sizes.emplace_back(type, 1);
  return {device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                               1, sizes)};
}

/// A compute shader with its two buffers and perhaps a texture.
class Kernel {
 public:
  Kernel(const vk::raii::Device& device, std::span<const std::uint32_t> spirv, bool with_texture)
      : device_(device),
        types_(bound_types(with_texture)),
        set_layout_(make_set_layout(device, types_)),
        layout_(make_layout(device, set_layout_)),
        pipeline_(make_pipeline(device, layout_, spirv)),
        pool_(make_pool(device, types_)),
        set_(std::move(
            vk::raii::DescriptorSets(device, vk::DescriptorSetAllocateInfo(*pool_, *set_layout_))
                .front())) {}

  void set_buffers(vk::Buffer input, vk::Buffer output) {
    const std::array buffers{vk::DescriptorBufferInfo(input, 0, VK_WHOLE_SIZE),
                             vk::DescriptorBufferInfo(output, 0, VK_WHOLE_SIZE)};
    device_.updateDescriptorSets(
        vk::WriteDescriptorSet(*set_, 0, 0, vk::DescriptorType::eStorageBuffer, nullptr, buffers),
        nullptr);
  }

  void set_texture(const VulkanTexture& texture) {
    const vk::DescriptorImageInfo image = texture.image_info();
    const vk::DescriptorImageInfo sampler = texture.sampler_info();
    const std::array writes{
        vk::WriteDescriptorSet(*set_, 2, 0, vk::DescriptorType::eSampledImage, image),
        vk::WriteDescriptorSet(*set_, 3, 0, vk::DescriptorType::eSampler, sampler)};
    device_.updateDescriptorSets(writes, nullptr);
  }

  void record(const vk::raii::CommandBuffer& commands, std::uint32_t count) const {
    constexpr auto compute = vk::PipelineBindPoint::eCompute;
    commands.bindPipeline(compute, *pipeline_);
    commands.bindDescriptorSets(compute, *layout_, 0, *set_, nullptr);
    commands.pushConstants<std::uint32_t>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, count);
    commands.dispatch((count + local_size - 1) / local_size, 1, 1);
    const vk::MemoryBarrier written(vk::AccessFlagBits::eShaderWrite,
                                    vk::AccessFlagBits::eHostRead);
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader,
                             vk::PipelineStageFlagBits::eHost, {}, written, nullptr, nullptr);
  }

 private:
  const vk::raii::Device& device_;
  std::vector<vk::DescriptorType> types_;
  vk::raii::DescriptorSetLayout set_layout_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline pipeline_;
  vk::raii::DescriptorPool pool_;
  vk::raii::DescriptorSet set_;
};

/// With buffers that keep what is beyond them safe, which every device can: without, SwiftShader
/// also stores for invocations that have returned, beyond the buffer's end.
vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical, std::uint32_t family) {
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue({}, family, 1, &priority);
  vk::PhysicalDeviceFeatures features;
  features.robustBufferAccess = VK_TRUE;
  return {physical, vk::DeviceCreateInfo({}, queue, {}, {}, &features)};
}

/// Runs `work` and gives an error of Vulkan the name of the device.
template <class Work>
auto with_name(const std::string& device, const Work& work) {
  try {
    return work();
  } catch (const vk::SystemError& error) {
    throw std::runtime_error("Vulkan device '" + device + "' failed: " + error.what());
  }
}

}  // namespace

/// The handles in the order in which they are made.
class VulkanDevice::Open {
 public:
  explicit Open(std::string_view name)
      : physical_(choose_device(name)),
        description_(describe(physical_)),
        family_(*queue_family(physical_)),
        device_(with_name(description_.name, [&] { return make_device(physical_, family_); })),
        queue_(device_, family_, 0),
        commands_(device_, vk::CommandPoolCreateInfo({}, family_)) {}

  const DeviceDescription& description() const { return description_; }

  /// The most elements that may be done at once; `floats_each` is the larger share of an element.
  std::uint32_t most_at_once(std::size_t floats_each) const {
    const vk::PhysicalDeviceLimits limits = physical_.getProperties().limits;
    const std::uint64_t by_groups = std::uint64_t{limits.maxComputeWorkGroupCount[0]} * local_size;
    const std::uint64_t by_range =
        limits.maxStorageBufferRange / (std::max(floats_each, std::size_t{1}) * sizeof(float));
    if (by_range == 0) {
      throw std::runtime_error("Vulkan device '" + description_.name + "': found " +
                               std::to_string(floats_each) +
                               " floats for one element, more than its buffers hold");
    }
    return static_cast<std::uint32_t>(
        std::min({by_groups, by_range, std::uint64_t{std::numeric_limits<std::uint32_t>::max()}}));
  }

  /// The texture in the device's memory.
  VulkanTexture make_texture(const SampledTexture& texture) const {
    VulkanTexture made(physical_, device_, texture, description_.name);
    run_commands([&](const vk::raii::CommandBuffer& commands) { made.record_upload(commands); });
    return made;
  }

  Kernel make_kernel(std::span<const std::uint32_t> spirv, bool with_texture) const {
    return {device_, spirv, with_texture};
  }

  void run(Kernel& kernel, std::span<const float> input, std::span<float> output,
           std::uint32_t count) const {
    constexpr auto storage = vk::BufferUsageFlagBits::eStorageBuffer;
    SharedBuffer in(physical_, device_, input.size_bytes(), storage);
    SharedBuffer out(physical_, device_, output.size_bytes(), storage);
    std::copy(input.begin(), input.end(), static_cast<float*>(in.data()));
    std::fill_n(static_cast<float*>(out.data()), output.size(), 0.F);
    kernel.set_buffers(in.buffer(), out.buffer());
    run_commands([&](const vk::raii::CommandBuffer& commands) { kernel.record(commands, count); });
    std::copy_n(static_cast<const float*>(out.data()), output.size(), output.begin());
  }

 private:
  /// Has the device do what `record` puts into the command buffer, and waits for it.
  template <class Record>
  void run_commands(const Record& record) const {
    const vk::raii::CommandBuffers buffers(
        device_, vk::CommandBufferAllocateInfo(*commands_, vk::CommandBufferLevel::ePrimary, 1));
    const vk::raii::CommandBuffer& commands = buffers.front();
    commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
    record(commands);
    commands.end();
    queue_.submit(vk::SubmitInfo({}, {}, *commands));
    queue_.waitIdle();
  }

  vk::raii::PhysicalDevice physical_;
  DeviceDescription description_;
  std::uint32_t family_;
  vk::raii::Device device_;
  vk::raii::Queue queue_;
  vk::raii::CommandPool commands_;
};

VulkanDevice::VulkanDevice(std::string_view name) : open_(std::make_unique<Open>(name)) {}
VulkanDevice::VulkanDevice(VulkanDevice&&) noexcept = default;
VulkanDevice& VulkanDevice::operator=(VulkanDevice&&) noexcept = default;
VulkanDevice::~VulkanDevice() = default;

const DeviceDescription& VulkanDevice::description() const { return open_->description(); }

std::vector<float> VulkanDevice::run(std::span<const std::uint32_t> spirv,
                                     std::span<const float> input, std::size_t output_size,
                                     std::uint32_t count, const SampledTexture* texture) {
  std::vector<float> output(output_size);
  if (count == 0) return output;
  if (input.size() % count != 0 || output_size % count != 0) {
    throw std::invalid_argument("run: found " + std::to_string(input.size()) + " inputs and " +
                                std::to_string(output_size) + " outputs, expected multiples of " +
                                std::to_string(count) + ", the count");
  }
  const std::size_t in_each = input.size() / count;
  const std::size_t out_each = output_size / count;
  with_name(description().name, [&] {
    Kernel kernel = open_->make_kernel(spirv, texture != nullptr);
    std::optional<VulkanTexture> on_device;
    if (texture != nullptr) kernel.set_texture(on_device.emplace(open_->make_texture(*texture)));
    const std::uint32_t most = open_->most_at_once(std::max(in_each, out_each));
    for (std::size_t first = 0; first < count;) {
      const auto part = static_cast<std::uint32_t>(std::min<std::size_t>(most, count - first));
      open_->run(kernel, input.subspan(first * in_each, part * in_each),
                 std::span(output).subspan(first * out_each, part * out_each), part);
      first += part;
    }
  });
  return output;
}

}  // namespace gonio::shader
