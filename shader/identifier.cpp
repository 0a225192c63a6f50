#include "shader/identifier.h"

namespace gonio::shader {
namespace {

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

}  // namespace

std::string identifier_from(std::string_view name) {
  constexpr std::string_view prefix = "brdf_";
  constexpr std::size_t longest = prefix.size() + 64;
  std::string identifier(prefix);
  for (const char c : name) {
    if (identifier.size() == longest) break;
    if (is_letter_or_digit(c)) {
      identifier += c;
    } else if (identifier.back() != '_') {  // GLSL keeps two in a row to itself
      identifier += '_';
    }
  }
  if (identifier.size() > prefix.size() && identifier.back() == '_') identifier.pop_back();
  return identifier == prefix ? identifier + "material" : identifier;
}

}  // namespace gonio::shader
