#include "shader/glsl.h"

#include <algorithm>
#include <array>
#include <utility>

namespace gonio::shader {
namespace {

/// What GLSL calls the word.
std::string_view glsl_word(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> words{
      {{"float2", "vec2"},
       {"float3", "vec3"},
       {"float4", "vec4"},
       {"asfloat", "uintBitsToFloat"},
       {"asuint", "floatBitsToUint"},
       {"precise", "GONIO_PRECISE"}}};
  const auto* const found =
      std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.first == word; });
  return found == words.end() ? word : found->second;
}

bool is_word_start(char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_space(char c) { return c == ' ' || c == '\n'; }

/// The length of the run of characters at the front of the text for which `belongs` holds.
template <class Predicate>
std::size_t run(std::string_view text, const Predicate& belongs) {
  return std::size_t(std::find_if_not(text.begin(), text.end(), belongs) - text.begin());
}

/// The length of the comment, word, number, preprocessor line, run of spaces or single character
/// that the text starts with.
std::size_t token_length(std::string_view text) {
  if (text.starts_with("//") || text.starts_with('#'))
    return run(text, [](char c) { return c != '\n'; });
  if (is_word_start(text.front()))
    return run(text, [](char c) { return is_word_start(c) || is_digit(c); });
  if (is_digit(text.front()))  // the sign of an exponent stays behind, which changes nothing
    return run(text, [](char c) { return is_word_start(c) || is_digit(c) || c == '.'; });
  if (is_space(text.front())) return run(text, is_space);
  return 1;
}

}  // namespace

std::string glsl_from_hlsl(std::string_view hlsl) {
  std::string glsl;
  bool after_static = false;
  while (!hlsl.empty()) {
    const std::string_view token = hlsl.substr(0, token_length(hlsl));
    hlsl.remove_prefix(token.size());
    const bool is_left_out = token == "static" || (after_static && is_space(token.front()));
    if (!is_left_out) glsl += glsl_word(token);
    after_static = token == "static";
  }
  return glsl;
}

}  // namespace gonio::shader
