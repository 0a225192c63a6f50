// The compute shader around a composed function.
#include <fmt/format.h>

#include <string_view>

#include "shader/compose.h"
#include "shader/glsl.h"
#include "shader/identifier.h"

namespace gonio::shader {
namespace {

constexpr std::string_view hlsl_buffers = R"(
[[vk::binding(0, 0)]] StructuredBuffer<float> directions;
[[vk::binding(1, 0)]] RWStructuredBuffer<float> values;
struct Pairs {
  uint count;
};
[[vk::push_constant]] ConstantBuffer<Pairs> pairs;

[numthreads(64, 1, 1)]
void main(uint3 invocation : SV_DispatchThreadID) {
  uint pair = invocation.x;
)";

constexpr std::string_view glsl_buffers = R"(
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Directions {
  float directions[];
};
layout(std430, set = 0, binding = 1) writeonly buffer Values {
  float values[];
};
layout(push_constant) uniform Pairs {
  uint count;
} pairs;

void main() {
  uint pair = gl_GlobalInvocationID.x;
)";

/// The rest of the kernel's main, in HLSL: evaluates the pair.
std::string kernel_body(const std::string& name, std::size_t channels) {
  constexpr std::size_t most_components = 4;  // of a shader type
  std::string body =
      "  if (pair >= pairs.count) return;\n"
      "  uint d = 6u * pair;\n"
      "  float3 wi = float3(directions[d], directions[d + 1u], directions[d + 2u]);\n"
      "  float3 wo = float3(directions[d + 3u], directions[d + 4u], directions[d + 5u]);\n";
  body += fmt::format("  uint first = {}u * pair;\n", channels);
  if (channels > most_components) {
    body += fmt::format(
        "  float f_r[{0}];\n  {1}(wi, wo, f_r);\n"
        "  for (uint channel = 0u; channel < {0}u; ++channel) {{\n"
        "    values[first + channel] = f_r[channel];\n  }}\n",
        channels, name);
    return body + "}\n";
  }
  if (channels == 1) return body + fmt::format("  values[first] = {}(wi, wo);\n}}\n", name);
  body += fmt::format("  float{} f_r = {}(wi, wo);\n", channels, name);
  for (std::size_t c = 0; c < channels; ++c) {
    body += fmt::format("  values[first + {}u] = f_r.{};\n", c, "xyzw"[c]);
  }
  return body + "}\n";
}

/// The function that reads the table; its name goes where {} stands.
constexpr std::string_view hlsl_table = R"(
[[vk::binding(2, 0)]] Texture2D<float4> table_texture;
[[vk::binding(3, 0)]] SamplerState table_sampler;
float4 {}(float2 uv) {{
  return table_texture.SampleLevel(table_sampler, uv, 0.0);
}}
)";

constexpr std::string_view glsl_table = R"(
layout(set = 0, binding = 2) uniform texture2D table_texture;
layout(set = 0, binding = 3) uniform sampler table_sampler;
vec4 {}(vec2 uv) {{
  return textureLod(sampler2D(table_texture, table_sampler), uv, 0.0);
}}
)";

/// The kernel around functions of the language.
std::string kernel(const std::string& functions, const brdf::BoundModel& model, Language language,
                   const SourceText& text) {
  const std::string body = kernel_body(identifier_from(text.name), model.channel_count());
  if (language == Language::hlsl) return functions + std::string(hlsl_buffers) + body;
  return "#version 450\n" + functions + std::string(glsl_buffers) + glsl_from_hlsl(body);
}

}  // namespace

std::string evaluation_kernel(const brdf::BoundModel& model, Language language,
                              const SourceText& text) {
  return kernel(function_source(model, language, text), model, language, text);
}

std::string evaluation_kernel(const brdf::BoundModel& model, const lut::Table& table,
                              Language language, const SourceText& text) {
  const std::string reading = fmt::format(
      fmt::runtime(language == Language::hlsl ? hlsl_table : glsl_table), table_function(text));
  return kernel(function_source(model, table, language, text) + reading, model, language, text);
}

}  // namespace gonio::shader
