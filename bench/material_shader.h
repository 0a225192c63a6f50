// The pixel shader around the function of a material (shader/compose.h): wi and wo in the local
// frame are interpolated and normalised, and the reflected light f_r cos_i is what it returns.
#pragma once

#include <string>
#include <string_view>

namespace gonio::bench {

/// How the parameters reach the shader: as the numbers that function_source() writes, of which a
/// compiler can work out a part, or as uniforms, as in a renderer with many materials.
enum class ParameterSource { literals, uniforms };

/// What the material has to be called; its function is brdf_material then.
inline constexpr std::string_view material_name = "material";

/// `function`: the HLSL text that function_source() gives for three channels and material_name. The
/// one of a table reads it from a sampled image at binding 2 of set 0 with the sampler at
/// binding 3. Throws std::invalid_argument if the parameters are to be uniforms and are not found
/// in the function, or not all of them.
std::string material_pixel_shader(std::string_view function, ParameterSource source);

/// The shader without a material: what its interface costs.
std::string empty_pixel_shader();

}  // namespace gonio::bench
