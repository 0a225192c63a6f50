#include "shader/instruction_counts.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <utility>
#include <vulkan/vulkan_raii.hpp>

#include "shader/vulkan_instance.h"

namespace gonio::shader {
namespace {

namespace fs = std::filesystem;

constexpr vk::Format target_format = vk::Format::eR32G32B32A32Sfloat;
constexpr std::uint32_t attribute_size = 3 * sizeof(float);

std::string variable_or(const char* name, const std::string& otherwise) {
  const char* const value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : otherwise;
}

/// Where the Vulkan loader looks for manifests (its documentation, "Driver Discovery on Linux").
std::vector<fs::path> manifest_folders() {
  const std::string home = variable_or("HOME", "");
  const std::array<std::string, 5> lists{
      variable_or("XDG_CONFIG_HOME", home + "/.config"), variable_or("XDG_CONFIG_DIRS", "/etc/xdg"),
      "/usr/local/etc:/etc", variable_or("XDG_DATA_HOME", home + "/.local/share"),
      variable_or("XDG_DATA_DIRS", "/usr/local/share:/usr/share")};
  std::vector<fs::path> folders;
  for (std::string_view list : lists) {
    while (!list.empty()) {
      const std::size_t end = std::min(list.find(':'), list.size());
      folders.push_back(fs::path(list.substr(0, end)) / "vulkan" / "icd.d");
      list.remove_prefix(std::min(end + 1, list.size()));
    }
  }
  return folders;
}

vk::raii::Context open_loader() {
  try {
    return {};
  } catch (const std::runtime_error&) {
    throw NoChipCompiler("no Vulkan loader (libvulkan.so.1): install libvulkan1");
  }
}

vk::raii::Instance make_instance(const vk::raii::Context& loader) {
  const vk::ApplicationInfo application("gonio", 0, nullptr, 0, VK_API_VERSION_1_3);
  return {loader, vk::InstanceCreateInfo({}, &application)};
}

bool has_extension(const vk::raii::PhysicalDevice& device, std::string_view name) {
  const auto extensions = device.enumerateDeviceExtensionProperties();
  return std::any_of(extensions.begin(), extensions.end(), [&](const auto& extension) {
    return std::string_view(extension.extensionName) == name;
  });
}

vk::raii::PhysicalDevice choose_device(const vk::raii::Instance& instance) {
  for (vk::raii::PhysicalDevice& device : vk::raii::PhysicalDevices(instance)) {
    if (device.getProperties().apiVersion >= VK_API_VERSION_1_3 &&
        has_extension(device, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME)) {
      return std::move(device);
    }
  }
  throw NoChipCompiler(
      "RADV makes no device of Vulkan 1.3 that tells what it compiles: install a newer Mesa");
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

/// Which of the pipeline's executables is the fragment shader.
std::uint32_t fragment_executable(const vk::raii::Device& device, vk::Pipeline pipeline) {
  const auto executables = device.getPipelineExecutablePropertiesKHR(pipeline);
  for (std::uint32_t e = 0; e < executables.size(); ++e) {
    if (executables[e].stages & vk::ShaderStageFlagBits::eFragment) return e;
  }
  throw NoChipCompiler("the driver does not tell of a fragment shader that it has compiled");
}

int number_of(const vk::PipelineExecutableStatisticKHR& statistic) {
  if (statistic.format != vk::PipelineExecutableStatisticFormatKHR::eUint64) {
    throw NoChipCompiler("the driver's '" + std::string(statistic.name.data()) +
                         "' is no whole number");
  }
  return static_cast<int>(
      std::min<std::uint64_t>(statistic.value.u64, std::numeric_limits<int>::max()));
}

int number_named(const std::vector<vk::PipelineExecutableStatisticKHR>& statistics,
                 std::string_view name) {
  const auto found = std::find_if(statistics.begin(), statistics.end(), [&](const auto& s) {
    return std::string_view(s.name.data()) == name;
  });
  if (found == statistics.end()) {
    throw NoChipCompiler("the driver does not tell the number of '" + std::string(name) +
                         "': found another version of Mesa than those known (22.3)");
  }
  return number_of(*found);
}

/// The machine code as text.
std::string disassembly_of(const vk::raii::Device& device,
                           const vk::PipelineExecutableInfoKHR& executable) {
  // The first time the sizes of the texts come, the second time the one that has memory.
  auto texts = device.getPipelineExecutableInternalRepresentationsKHR(executable);
  const auto code = std::find_if(texts.begin(), texts.end(), [](const auto& text) {
    return std::string_view(text.name.data()) == "Assembly";
  });
  if (code == texts.end()) throw NoChipCompiler("the driver does not show its machine code");
  std::string text(code->dataSize, '\0');
  code->pData = text.data();
  auto count = static_cast<std::uint32_t>(texts.size());
  const VkResult result = device.getDispatcher()->vkGetPipelineExecutableInternalRepresentationsKHR(
      *device, &static_cast<const VkPipelineExecutableInfoKHR&>(executable), &count,
      reinterpret_cast<VkPipelineExecutableInternalRepresentationKHR*>(texts.data()));
  if (result != VK_SUCCESS) throw NoChipCompiler("the driver does not show its machine code");
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

InstructionCounts counts_of(const vk::raii::Device& device, vk::Pipeline pipeline) {
  const vk::PipelineExecutableInfoKHR executable(pipeline, fragment_executable(device, pipeline));
  const auto statistics = device.getPipelineExecutableStatisticsKHR(executable);
  InstructionCounts counts;
  counts.disassembly = disassembly_of(device, executable);
  counts.operations = count_operations(counts.disassembly);
  // The assembler may add some to those that the compiler counts.
  if (counts.operations.instructions < number_named(statistics, "Instructions")) {
    throw NoChipCompiler(
        "the driver cannot disassemble for this chip: choose a newer one, or install its "
        "disassembler (clrxdisasm for those before GCN 3)");
  }
  counts.vector_registers = number_named(statistics, "VGPRs");
  counts.scalar_registers = number_named(statistics, "SGPRs");
  counts.estimated_latency = number_named(statistics, "Latency");
  counts.estimated_inverse_throughput = number_named(statistics, "Inverse Throughput");
  return counts;
}

/// Runs `work`; an error of Vulkan is one of the driver.
template <class Work>
auto with_advice(const Work& work) {
  try {
    return work();
  } catch (const vk::SystemError& error) {
    throw NoChipCompiler(std::string("RADV does not compile (") + error.what() +
                         "): install Mesa's Vulkan drivers (mesa-vulkan-drivers)");
  }
}

}  // namespace

/// The handles in the order in which they are made.
class ChipCompiler::Open {
 public:
  std::string device_text() const { return text_of(describe(physical_)); }

  InstructionCounts count(std::span<const std::uint32_t> vertex,
                          std::span<const std::uint32_t> fragment) const {
    const vk::raii::ShaderModule vertex_module = make_module(device_, vertex);
    const vk::raii::ShaderModule fragment_module = make_module(device_, fragment);
    const vk::raii::Pipeline pipeline =
        make_pipeline(device_, *layout_, *vertex_module, *fragment_module);
    return counts_of(device_, *pipeline);
  }

 private:
  vk::raii::Context loader_ = open_loader();
  vk::raii::Instance instance_ = make_instance(loader_);
  vk::raii::PhysicalDevice physical_ = choose_device(instance_);
  vk::raii::Device device_ = make_device(physical_);
  vk::raii::DescriptorSetLayout set_layout_ = make_set_layout(device_);
  vk::raii::PipelineLayout layout_{device_, vk::PipelineLayoutCreateInfo({}, *set_layout_)};
};

std::vector<fs::path> radv_manifests() {
  std::vector<fs::path> manifests;
  for (const fs::path& folder : manifest_folders()) {
    std::error_code no_folder;
    for (const auto& entry : fs::directory_iterator(folder, no_folder)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("radeon_icd") && name.ends_with(".json")) {
        manifests.push_back(entry.path());
      }
    }
  }
  return manifests;
}

std::vector<std::string> chip_environment(const std::string& chip,
                                          std::span<const fs::path> manifests) {
  std::string list;
  for (const fs::path& path : manifests) list += (list.empty() ? "" : ":") + path.string();
  // Newer loaders read the first, older ones the second. The last silences a remark on stderr.
  return {"VK_DRIVER_FILES=" + list, "VK_ICD_FILENAMES=" + list, "RADV_FORCE_FAMILY=" + chip,
          "MESA_VK_IGNORE_CONFORMANCE_WARNING=true"};
}

ChipCompiler::ChipCompiler() : open_(with_advice([] { return std::make_unique<Open>(); })) {}
ChipCompiler::ChipCompiler(ChipCompiler&&) noexcept = default;
ChipCompiler& ChipCompiler::operator=(ChipCompiler&&) noexcept = default;
ChipCompiler::~ChipCompiler() = default;

std::string ChipCompiler::device_text() const { return open_->device_text(); }

InstructionCounts ChipCompiler::count(std::span<const std::uint32_t> vertex_spirv,
                                      std::span<const std::uint32_t> fragment_spirv) const {
  return with_advice([&] { return open_->count(vertex_spirv, fragment_spirv); });
}

}  // namespace gonio::shader
