// GLSL from the HLSL of shader/hlsl, so that each term has one source.
#pragma once

#include <string>
#include <string_view>

namespace gonio::shader {

/// The text in GLSL 4.50 and GLSL ES 3.00. It has to be of the subset that both languages share but
/// for names: float, int, bool, float2 to float4 and structs of them; functions; const; `static
/// const` at file scope; no casts, intrinsics that both have under one name, floats written with a
/// point or an exponent. Comments and preprocessor lines stay as they are.
std::string glsl_from_hlsl(std::string_view hlsl);

}  // namespace gonio::shader
