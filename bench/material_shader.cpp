#include "bench/material_shader.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

namespace gonio::bench {
namespace {

constexpr std::string_view entry = R"(
float4 main([[vk::location(0)]] float3 to_light : LIGHT,
            [[vk::location(1)]] float3 to_viewer : VIEWER) : SV_Target {
  float3 wi = normalize(to_light);
  float3 wo = normalize(to_viewer);
  return float4(brdf_material(wi, wo) * wi.z, 1.0);
}
)";

constexpr std::string_view material_signature = "float3 brdf_material(float3 wi, float3 wo) {";

/// Declared by the function of a material with a table.
constexpr std::string_view table_function = "brdf_material_table";

constexpr std::string_view table_reading = R"(
[[vk::binding(2, 0)]] Texture2D<float4> table_texture;
[[vk::binding(3, 0)]] SamplerState table_sampler;
float4 brdf_material_table(float2 uv) {
  return table_texture.SampleLevel(table_sampler, uv, 0.0);
}
)";

/// Begins the line of a parameter: `  const float2 NAME = VALUE;`
constexpr std::string_view qualifier = "  const ";

/// The lines, each with its end.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t size = std::min(text.find('\n'), text.size() - 1) + 1;
    lines.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return lines;
}

/// `float2 NAME;` of a constant's line.
std::string declaration_of(std::string_view line) {
  const std::string_view declaration = line.substr(qualifier.size());
  return std::string(declaration.substr(0, declaration.find(" ="))) + ";\n";
}

/// A uniform buffer, the longer vectors first: so HLSL's layout is std140 as well, which GLSL
/// wants.
std::string uniform_buffer(std::vector<std::string> declarations) {
  const auto components = [](const std::string& declaration) {
    const char last = declaration[declaration.find(' ') - 1];
    return last >= '2' && last <= '4' ? last - '0' : 1;
  };
  std::stable_sort(declarations.begin(), declarations.end(),
                   [&](const auto& a, const auto& b) { return components(a) > components(b); });
  std::string buffer = "cbuffer Material : register(b0) {\n";
  for (const std::string& declaration : declarations) buffer += "  " + declaration;
  return buffer + "};\n";
}

/// Where the function of the material begins; before it stands what it calls.
std::size_t begin_of_material(std::string_view text) {
  const std::size_t begin = text.find(material_signature);
  if (begin == text.npos) {
    throw std::invalid_argument(fmt::format(
        "uniforms: found no function '{}', expected that of a material in three channels",
        material_signature));
  }
  return begin;
}

/// Makes sure that no parameter has stayed a number: then its cost would be a literal's.
void check_uniforms(const std::vector<std::string>& uniforms, std::string_view rest) {
  if (!uniforms.empty() && rest.find("const ") == rest.npos) return;
  throw std::invalid_argument(
      fmt::format("uniforms: found {} in the function, expected each parameter as a line '{}TYPE "
                  "NAME = VALUE;', which shader/function_text.cpp writes",
                  uniforms.empty() ? "no parameter" : "constants in other lines", qualifier));
}

/// The function with its parameters in a uniform buffer.
std::string with_uniforms(std::string_view text) {
  const std::size_t begin = begin_of_material(text);
  std::vector<std::string> uniforms;
  std::string rest;
  for (const std::string_view line : lines_of(text.substr(begin))) {
    if (line.starts_with(qualifier)) {
      uniforms.push_back(declaration_of(line));
    } else {
      rest += line;
    }
  }
  check_uniforms(uniforms, rest);
  return uniform_buffer(std::move(uniforms)).append(text.substr(0, begin)).append(rest);
}

}  // namespace

std::string material_pixel_shader(std::string_view function, ParameterSource source) {
  const bool has_uniforms = source == ParameterSource::uniforms;
  std::string text = has_uniforms ? with_uniforms(function) : std::string(function);
  if (text.find(table_function) != std::string::npos) text += table_reading;
  return text.append(entry);
}

std::string empty_pixel_shader() {
  return "float3 brdf_material(float3 wi, float3 wo) { return wi * wo.z; }\n" + std::string(entry);
}

}  // namespace gonio::bench
