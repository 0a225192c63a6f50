// What a driver tells of the fragment shader that it has compiled, by
// VK_KHR_pipeline_executable_properties and in the words of Mesa's RADV.
//
// For the .cpp files of this room only: those that include it need the headers of Vulkan.
#pragma once

#include <vulkan/vulkan_raii.hpp>

#include "shader/instruction_counts.h"

namespace gonio::shader {

/// Of a pipeline that was made with its statistics and internal representations captured. Throws
/// NoChipCompiler if the driver leaves out one of the numbers.
InstructionCounts fragment_counts(const vk::raii::Device& device, vk::Pipeline pipeline);

}  // namespace gonio::shader
