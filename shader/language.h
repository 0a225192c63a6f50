// The shading languages that a material can be written in.
#pragma once

namespace gonio::shader {

enum class Language { hlsl, glsl };

}  // namespace gonio::shader
