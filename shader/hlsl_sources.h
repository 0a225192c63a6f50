// The HLSL sources of shader/hlsl, built into the library. Each file stands for itself: it is
// guarded, and includes what it needs, so that a renderer may include the files as they are.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace gonio::shader {

struct HlslSource {
  std::string_view file;  // "ward.hlsl"
  std::string_view text;
};

/// All of them, sorted by file.
std::span<const HlslSource> hlsl_sources();

/// The texts of `files` and of all that they include, directly or not, each once and after what it
/// needs, without the #include lines. Throws std::logic_error for a file that is not there.
std::string hlsl_with_includes(std::span<const std::string_view> files);

}  // namespace gonio::shader
