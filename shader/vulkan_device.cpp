#include "shader/vulkan_device.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vulkan/vulkan_raii.hpp>

namespace gonio::shader {
namespace {

constexpr std::uint32_t local_size = 64;

/// What SPIR-V 1.3, the target of compile(), needs.
constexpr std::uint32_t least_api_version = VK_API_VERSION_1_1;

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
    const vk::ApplicationInfo application("gonio", 0, nullptr, 0, least_api_version);
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
  const auto extensions = device.enumerateDeviceExtensionProperties();
  const bool is_told =
      device.getProperties().apiVersion >= VK_API_VERSION_1_2 ||
      std::any_of(extensions.begin(), extensions.end(), [](const vk::ExtensionProperties& e) {
        return std::string_view(e.extensionName) == VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME;
      });
  if (!is_told) return {};
  const auto chain =
      device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
  const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
  const std::string name(driver.driverName.data());
  const std::string info(driver.driverInfo.data());
  return info.empty() ? name : name + ", " + info;
}

DeviceDescription describe(const vk::raii::PhysicalDevice& device) {
  const vk::PhysicalDeviceProperties properties = device.getProperties();
  return {std::string(properties.deviceName.data()), driver_of(device),
          type_of(properties.deviceType), version_text(properties.apiVersion)};
}

/// A family that computes, if there is one: rather one that draws as well.
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

/// The loader holds it for an error that drivers have no hardware.
std::vector<vk::raii::PhysicalDevice> all_devices() {
  try {
    return vk::raii::PhysicalDevices(instance());
  } catch (const vk::InitializationFailedError&) {
    return {};
  }
}

/// Those that can compute, the best first.
std::vector<vk::raii::PhysicalDevice> usable_devices() {
  std::vector<vk::raii::PhysicalDevice> usable;
  for (vk::raii::PhysicalDevice& device : all_devices()) {
    if (device.getProperties().apiVersion < least_api_version || !queue_family(device)) continue;
    usable.push_back(std::move(device));
  }
  std::stable_sort(usable.begin(), usable.end(), [](const auto& a, const auto& b) {
    return type_of(a.getProperties().deviceType) < type_of(b.getProperties().deviceType);
  });
  return usable;
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

/// Memory that both sides see, with a buffer over all of it.
class SharedBuffer {
 public:
  SharedBuffer(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device,
               std::size_t float_count)
      : buffer_(device,
                vk::BufferCreateInfo({}, std::max(float_count, std::size_t{1}) * sizeof(float),
                                     vk::BufferUsageFlagBits::eStorageBuffer)),
        memory_(allocate(physical, device, buffer_)) {
    buffer_.bindMemory(*memory_, 0);
    values_ = static_cast<float*>(memory_.mapMemory(0, VK_WHOLE_SIZE));
  }

  vk::Buffer buffer() const { return *buffer_; }
  float* values() { return values_; }

 private:
  static vk::raii::DeviceMemory allocate(const vk::raii::PhysicalDevice& physical,
                                         const vk::raii::Device& device,
                                         const vk::raii::Buffer& buffer) {
    constexpr auto shared =
        vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
    const vk::MemoryRequirements needs = buffer.getMemoryRequirements();
    const vk::PhysicalDeviceMemoryProperties memory = physical.getMemoryProperties();
    std::uint32_t type = 0;
    // Vulkan promises one of these to every buffer.
    while ((needs.memoryTypeBits >> type & 1) == 0 ||
           (memory.memoryTypes[type].propertyFlags & shared) != shared) {
      ++type;
    }
    return {device, vk::MemoryAllocateInfo(needs.size, type)};
  }

  vk::raii::Buffer buffer_;
  vk::raii::DeviceMemory memory_;
  float* values_ = nullptr;
};

vk::raii::DescriptorSetLayout make_set_layout(const vk::raii::Device& device) {
  constexpr auto type = vk::DescriptorType::eStorageBuffer;
  constexpr auto stage = vk::ShaderStageFlagBits::eCompute;
  const std::array bindings{vk::DescriptorSetLayoutBinding(0, type, 1, stage),
                            vk::DescriptorSetLayoutBinding(1, type, 1, stage)};
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

vk::raii::DescriptorPool make_pool(const vk::raii::Device& device) {
  const vk::DescriptorPoolSize buffers(vk::DescriptorType::eStorageBuffer, 2);
  return {device, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                               1, buffers)};
}

/// A compute shader with its two buffers.
class Kernel {
 public:
  Kernel(const vk::raii::Device& device, std::span<const std::uint32_t> spirv)
      : device_(device),
        set_layout_(make_set_layout(device)),
        layout_(make_layout(device, set_layout_)),
        pipeline_(make_pipeline(device, layout_, spirv)),
        pool_(make_pool(device)),
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

  void record(const vk::raii::CommandBuffer& commands, std::uint32_t count) const {
    constexpr auto compute = vk::PipelineBindPoint::eCompute;
    commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
    commands.bindPipeline(compute, *pipeline_);
    commands.bindDescriptorSets(compute, *layout_, 0, *set_, nullptr);
    commands.pushConstants<std::uint32_t>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, count);
    commands.dispatch((count + local_size - 1) / local_size, 1, 1);
    const vk::MemoryBarrier written(vk::AccessFlagBits::eShaderWrite,
                                    vk::AccessFlagBits::eHostRead);
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader,
                             vk::PipelineStageFlagBits::eHost, {}, written, nullptr, nullptr);
    commands.end();
  }

 private:
  const vk::raii::Device& device_;
  vk::raii::DescriptorSetLayout set_layout_;
  vk::raii::PipelineLayout layout_;
  vk::raii::Pipeline pipeline_;
  vk::raii::DescriptorPool pool_;
  vk::raii::DescriptorSet set_;
};

vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical, std::uint32_t family) {
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue({}, family, 1, &priority);
  return {physical, vk::DeviceCreateInfo({}, queue)};
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

  Kernel make_kernel(std::span<const std::uint32_t> spirv) const { return {device_, spirv}; }

  void run(Kernel& kernel, std::span<const float> input, std::span<float> output,
           std::uint32_t count) const {
    SharedBuffer in(physical_, device_, input.size());
    SharedBuffer out(physical_, device_, output.size());
    std::copy(input.begin(), input.end(), in.values());
    std::fill_n(out.values(), output.size(), 0.F);
    kernel.set_buffers(in.buffer(), out.buffer());
    const vk::raii::CommandBuffers buffers(
        device_, vk::CommandBufferAllocateInfo(*commands_, vk::CommandBufferLevel::ePrimary, 1));
    kernel.record(buffers.front(), count);
    submit(*buffers.front());
    std::copy_n(out.values(), output.size(), output.begin());
  }

 private:
  void submit(vk::CommandBuffer commands) const {
    queue_.submit(vk::SubmitInfo({}, {}, commands));
    queue_.waitIdle();
  }

  vk::raii::PhysicalDevice physical_;
  DeviceDescription description_;
  std::uint32_t family_;
  vk::raii::Device device_;
  vk::raii::Queue queue_;
  vk::raii::CommandPool commands_;
};

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

std::vector<DeviceDescription> vulkan_devices() {
  std::vector<DeviceDescription> descriptions;
  for (const vk::raii::PhysicalDevice& device : usable_devices()) {
    descriptions.push_back(describe(device));
  }
  return descriptions;
}

VulkanDevice::VulkanDevice(std::string_view name) : open_(std::make_unique<Open>(name)) {}
VulkanDevice::VulkanDevice(VulkanDevice&&) noexcept = default;
VulkanDevice& VulkanDevice::operator=(VulkanDevice&&) noexcept = default;
VulkanDevice::~VulkanDevice() = default;

const DeviceDescription& VulkanDevice::description() const { return open_->description(); }

std::vector<float> VulkanDevice::run(std::span<const std::uint32_t> spirv,
                                     std::span<const float> input, std::size_t output_size,
                                     std::uint32_t count) {
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
    Kernel kernel = open_->make_kernel(spirv);
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
