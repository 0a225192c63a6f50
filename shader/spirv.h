// Shader text to SPIR-V, in process, with glslang.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "shader/language.h"

namespace gonio::shader {

enum class Stage { vertex, fragment, compute };

/// The SPIR-V words of a shader of the stage for Vulkan 1.1, whose entry point is `main`. They are
/// valid: the SPIR-V Tools have looked at them. May be called by several threads at once.
///
/// Throws std::runtime_error with the compiler's messages, in one line, for a text that does not
/// compile.
std::vector<std::uint32_t> compile(std::string_view source, Language language,
                                   Stage stage = Stage::compute);

}  // namespace gonio::shader
