#include "shader/instruction_counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "shader/pipeline_statistics.h"
#include "shader/vulkan_instance.h"

namespace gonio::shader {
namespace {

constexpr vk::Format target_format = vk::Format::eR32G32B32A32Sfloat;
constexpr std::uint32_t attribute_size = 3 * sizeof(float);

/// Whether the null device compiles for the chip: "Null hardware (RADV NAVI21)".
bool is_of_chip(std::string_view device_name, std::string_view chip) {
  std::string text = "(RADV ";
  for (const char c : chip) text += 'a' <= c && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  const std::size_t at = device_name.find(text);
  if (at == device_name.npos) return false;
  const std::string_view after = device_name.substr(at + text.size());
  return after.starts_with(')') || after.starts_with(' ');  // a blank: another compiler's name
}

bool is_radv(const vk::raii::PhysicalDevice& device) {
  if (device.getProperties().apiVersion < VK_API_VERSION_1_2) return false;
  const auto chain =
      device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
  return chain.get<vk::PhysicalDeviceDriverProperties>().driverID == vk::DriverId::eMesaRadv;
}

/// Why none of the devices is the one.
std::string no_null_device(std::string_view chip,
                           const std::vector<vk::raii::PhysicalDevice>& devices) {
  std::string names;
  for (const vk::raii::PhysicalDevice& device : devices) {
    const vk::PhysicalDeviceProperties properties = device.getProperties();
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", properties.deviceName.data());
  }
  if (!devices.empty() && std::none_of(devices.begin(), devices.end(), is_radv)) {
    return fmt::format(
        "found {}, expected Mesa's driver RADV: its manifest is radeon_icd*.json of "
        "mesa-vulkan-drivers",
        names);
  }
  return fmt::format(
      "this Mesa has no null device for '{}' (found {}): install Mesa 22.3, which has one (26.2 "
      "and "
      "later have none), or name the manifest of its RADV",
      chip, names.empty() ? "no device" : names);
}

/// RADV's null device for the chip: a GPU that is there would be counted under another's name.
vk::raii::PhysicalDevice choose_null_device(std::string_view chip) {
  std::vector<vk::raii::PhysicalDevice> devices = all_devices();
  const auto found = std::find_if(devices.begin(), devices.end(), [&](const auto& device) {
    const vk::PhysicalDeviceProperties properties = device.getProperties();
    return is_null_device(properties) && is_radv(device) &&
           is_of_chip(properties.deviceName.data(), chip);
  });
  if (found == devices.end()) throw NoChipCompiler(no_null_device(chip, devices));
  if (found->getProperties().apiVersion < VK_API_VERSION_1_3 ||
      !has_extension(*found, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME)) {
    throw NoChipCompiler(
        fmt::format("'{}' has no Vulkan 1.3 that tells what it compiles: install Mesa 22.3, "
                    "or choose a newer chip",
                    found->getProperties().deviceName.data()));
  }
  return std::move(*found);
}

vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical) {
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue({}, 0, 1, &priority);
  const char* const extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
  const vk::StructureChain features{
      vk::DeviceCreateInfo({}, queue, {}, extension),
      vk::PhysicalDeviceDynamicRenderingFeatures(VK_TRUE),
      vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR(VK_TRUE)};
  return {physical, features.get<vk::DeviceCreateInfo>()};
}

vk::raii::DescriptorSetLayout make_set_layout(const vk::raii::Device& device) {
  constexpr auto stage = vk::ShaderStageFlagBits::eFragment;
  const std::array bindings{
      vk::DescriptorSetLayoutBinding(0, vk::DescriptorType::eUniformBuffer, 1, stage),
      vk::DescriptorSetLayoutBinding(2, vk::DescriptorType::eSampledImage, 1, stage),
      vk::DescriptorSetLayoutBinding(3, vk::DescriptorType::eSampler, 1, stage)};
  return {device, vk::DescriptorSetLayoutCreateInfo({}, bindings)};
}

vk::raii::ShaderModule make_module(const vk::raii::Device& device,
                                   std::span<const std::uint32_t> spirv) {
  return {device, vk::ShaderModuleCreateInfo({}, spirv.size_bytes(), spirv.data())};
}

/// Three vectors a vertex.
std::array<vk::VertexInputAttributeDescription, 3> vertex_attributes() {
  std::array<vk::VertexInputAttributeDescription, 3> attributes;
  for (std::uint32_t i = 0; i < attributes.size(); ++i) {
    attributes[i] = {i, 0, vk::Format::eR32G32B32Sfloat, i * attribute_size};
  }
  return attributes;
}

/// A pipeline of triangles, whose driver keeps what it knows of it.
vk::raii::Pipeline make_pipeline(const vk::raii::Device& device, vk::PipelineLayout layout,
                                 vk::ShaderModule vertex, vk::ShaderModule fragment) {
  const std::array stages{
      vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eVertex, vertex, "main"),
      vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eFragment, fragment, "main")};
  const std::array attributes = vertex_attributes();
  const vk::VertexInputBindingDescription buffer(0, attribute_size * attributes.size());
  const vk::PipelineVertexInputStateCreateInfo vertices({}, buffer, attributes);
  const vk::PipelineInputAssemblyStateCreateInfo triangles({},
                                                           vk::PrimitiveTopology::eTriangleList);
  const vk::Viewport view(0, 0, 1, 1, 0, 1);
  const vk::Rect2D scissor({0, 0}, {1, 1});
  const vk::PipelineViewportStateCreateInfo viewport({}, view, scissor);
  vk::PipelineRasterizationStateCreateInfo fill;
  fill.lineWidth = 1;
  const vk::PipelineMultisampleStateCreateInfo one_sample;
  vk::PipelineColorBlendAttachmentState no_blending;
  no_blending.colorWriteMask = vk::ColorComponentFlagBits::eR | vk::ColorComponentFlagBits::eG |
                               vk::ColorComponentFlagBits::eB | vk::ColorComponentFlagBits::eA;
  const vk::PipelineColorBlendStateCreateInfo blending({}, VK_FALSE, vk::LogicOp::eCopy,
                                                       no_blending);
  const vk::PipelineRenderingCreateInfo target(0, target_format);
  vk::GraphicsPipelineCreateInfo info(
      vk::PipelineCreateFlagBits::eCaptureStatisticsKHR |
          vk::PipelineCreateFlagBits::eCaptureInternalRepresentationsKHR,
      stages, &vertices, &triangles, nullptr, &viewport, &fill, &one_sample, nullptr, &blending,
      nullptr, layout);
  info.pNext = &target;
  return {device, nullptr, info};
}

/// Runs `work`; an error of Vulkan is one of the driver.
template <class Work>
auto with_advice(const Work& work) {
  try {
    return work();
  } catch (const NoVulkanDevice& error) {
    const char* const files = std::getenv("VK_DRIVER_FILES");
    throw NoChipCompiler(fmt::format("{}; VK_DRIVER_FILES is {}", error.what(),
                                     files != nullptr ? fmt::format("'{}'", files) : "not set"));
  } catch (const vk::SystemError& error) {
    throw NoChipCompiler(fmt::format(
        "RADV does not compile ({}): choose another chip, or another version of Mesa (22.3 does)",
        error.what()));
  }
}

}  // namespace

/// The handles in the order in which they are made.
class ChipCompiler::Open {
 public:
  explicit Open(std::string_view chip) : physical_(choose_null_device(chip)) {}

  std::string device_text() const { return text_of(describe(physical_)); }

  InstructionCounts count(std::span<const std::uint32_t> vertex,
                          std::span<const std::uint32_t> fragment) const {
    const vk::raii::ShaderModule vertex_module = make_module(device_, vertex);
    const vk::raii::ShaderModule fragment_module = make_module(device_, fragment);
    const vk::raii::Pipeline pipeline =
        make_pipeline(device_, *layout_, *vertex_module, *fragment_module);
    return fragment_counts(device_, *pipeline);
  }

 private:
  vk::raii::PhysicalDevice physical_;
  vk::raii::Device device_ = make_device(physical_);
  vk::raii::DescriptorSetLayout set_layout_ = make_set_layout(device_);
  vk::raii::PipelineLayout layout_{device_, vk::PipelineLayoutCreateInfo({}, *set_layout_)};
};

ChipCompiler::ChipCompiler(std::string_view chip)
    : open_(with_advice([&] { return std::make_unique<Open>(chip); })) {}
ChipCompiler::ChipCompiler(ChipCompiler&&) noexcept = default;
ChipCompiler& ChipCompiler::operator=(ChipCompiler&&) noexcept = default;
ChipCompiler::~ChipCompiler() = default;

std::string ChipCompiler::device_text() const { return open_->device_text(); }

InstructionCounts ChipCompiler::count(std::span<const std::uint32_t> vertex_spirv,
                                      std::span<const std::uint32_t> fragment_spirv) const {
  return with_advice([&] { return open_->count(vertex_spirv, fragment_spirv); });
}

}  // namespace gonio::shader
