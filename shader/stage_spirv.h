// Text of a vertex or fragment shader to SPIR-V, in process, with glslang; spirv.h does it for
// compute shaders.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gonio::shader {

enum class DrawingStage { vertex, fragment };

/// The SPIR-V words, for Vulkan 1.1 and validated, of an HLSL shader whose entry point is `main`.
///
/// Throws std::runtime_error with the compiler's messages for a text that does not compile.
std::vector<std::uint32_t> compile_drawing(const std::string& hlsl, DrawingStage stage);

}  // namespace gonio::shader
