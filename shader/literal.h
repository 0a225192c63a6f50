// Numbers and types as shader text, in HLSL; glsl_from_hlsl() translates them.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace gonio::shader {

/// The double as a float literal, in a form that a shader's float can hold: at most 1e18, and 0
/// for what is less than normal.
std::string literal(double value);

/// The name of the type of that many floats, 1 to 4.
std::string type_of(std::size_t components);

/// One number or a vector of them, 1 to 4.
std::string value_of(std::span<const double> components);

/// What has to be said about the values that literal() does not hold as they are; mostly nothing.
std::string remark(std::span<const double> values);

}  // namespace gonio::shader
