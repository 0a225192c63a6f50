// Names of shader functions made from names of materials.
#pragma once

#include <string>
#include <string_view>

namespace gonio::shader {

/// `brdf_` and the ASCII letters and digits of the name, 64 at most, with single underscores for
/// what is between them: `brdf_rolled_brass`. `brdf_material` for a name that has none. With the
/// prefix it is an identifier in HLSL and GLSL, and no word, function or reserved name of either.
std::string identifier_from(std::string_view name);

}  // namespace gonio::shader
