#include "shader/literal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio::shader {
namespace {

/// A coefficient times a basis function, both at most this, is a float; as gonio_largest of
/// quotient.hlsl.
constexpr double largest = 1e18;

bool is_less_than_normal(double value) {
  return std::abs(value) < double(std::numeric_limits<float>::min());
}

}  // namespace

std::string literal(double value) {
  const double held = is_less_than_normal(value) ? 0 : std::clamp(value, -largest, largest);
  std::string text = fmt::format("{}", held);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string type_of(std::size_t components) {
  return components == 1 ? "float" : fmt::format("float{}", components);
}

std::string value_of(std::span<const double> components) {
  if (components.size() == 1) return literal(components.front());
  std::string list;
  for (const double c : components) {
    list += list.empty() ? "" : ", ";
    list += literal(c);
  }
  return fmt::format("{}({})", type_of(components.size()), list);
}

std::string remark(std::span<const double> values) {
  std::string text;
  for (const double value : values) {
    const bool is_held = (value == 0 || !is_less_than_normal(value)) && std::abs(value) <= largest;
    if (is_held) continue;
    text += fmt::format("{}{} is beyond a shader's float", text.empty() ? "" : "; ", value);
  }
  return text;
}

}  // namespace gonio::shader
