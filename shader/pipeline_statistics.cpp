#include "shader/pipeline_statistics.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::shader {
namespace {

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

}  // namespace

InstructionCounts fragment_counts(const vk::raii::Device& device, vk::Pipeline pipeline) {
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

}  // namespace gonio::shader
