// Shader functions that evaluate a material, put together from the HLSL sources of its terms.
//
// The function gives f_r in 1/sr, without the cosine, for unit vectors in the local frame
// (brdf/direction.h), and exactly 0 below the horizon. Its constants are the parameters as the
// shortest text that reads back to the same double. A float in a shader need not know infinity, NaN
// or numbers below the smallest normal one: coefficients beyond 1e18 are written as 1e18, what
// float would hold as 0 or less than normal is written as 0.0, either with a remark beside it, and
// basis functions saturate at 1e18, so that the values stay finite.
#pragma once

#include <string>
#include <vector>

#include "brdf/bound_model.h"
#include "lut/table.h"
#include "shader/language.h"

namespace gonio::shader {

/// What the text says beyond the model.
struct SourceText {
  /// Of the material; the function is called identifier_from(name).
  std::string name;
  /// Lines of the comment at the top, without comment signs.
  std::vector<std::string> header;
};

/// A function and all that it needs, to be pasted or included into a shader: no entry point, no
/// resources. Two such texts, for two materials, may stand in one shader if their identifiers
/// (identifier.h) differ: the functions that they share are guarded.
///
/// For 1 to 4 channels `T NAME(float3 wi, float3 wo)` with T = float to float4; for more `void
/// NAME(float3 wi, float3 wo, out float f_r[N])`. HLSL is for fxc's shader model 5 and later, GLSL
/// for 4.50 and ES 3.00 (where it sets the precision to highp).
std::string function_source(const brdf::BoundModel& model, Language language,
                            const SourceText& text);

/// The same with the terms that the table serves read from it, as lut::TableModel does it. The text
/// declares a function `float4 table_function(text)(float2 uv)`, which the shader around it has to
/// define: it samples the table's texture at uv without mipmaps, clamped at the edges. Throws
/// std::invalid_argument as lut::TableModel.
std::string function_source(const brdf::BoundModel& model, const lut::Table& table,
                            Language language, const SourceText& text);

/// identifier_from(text.name) and `_table`.
std::string table_function(const SourceText& text);

/// A compute shader for Vulkan with that function: entry point `main`, groups of 64. Invocation i
/// below the push constant `uint count` reads the floats 6 i to 6 i + 5 of the storage buffer at
/// binding 0 of set 0 as wi and wo, and writes the channels' f_r to the floats from i times the
/// number of channels of the one at binding 1.
std::string evaluation_kernel(const brdf::BoundModel& model, Language language,
                              const SourceText& text);

/// The same with the table as the sampled image at binding 2 of set 0, read by the sampler at
/// binding 3 (VulkanDevice::run).
std::string evaluation_kernel(const brdf::BoundModel& model, const lut::Table& table,
                              Language language, const SourceText& text);

}  // namespace gonio::shader
