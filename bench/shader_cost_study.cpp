#include "bench/shader_cost_study.h"

#include <string_view>

#include "bench/material_functions.h"
#include "bench/material_shader.h"
#include "bench/shader_cost_listings.h"
#include "shader/spirv.h"

namespace gonio::bench {
namespace {

/// Hands on three vectors of which the compiler knows nothing.
constexpr std::string_view vertex_shader = R"(
struct Vertex {
  [[vk::location(0)]] float3 a : A;
  [[vk::location(1)]] float3 b : B;
  [[vk::location(2)]] float3 c : C;
};
struct Interpolated {
  float4 position : SV_Position;
  [[vk::location(0)]] float3 a : A;
  [[vk::location(1)]] float3 b : B;
  [[vk::location(2)]] float3 c : C;
};
Interpolated main(Vertex vertex) {
  Interpolated to;
  to.position = float4(vertex.a, 1);
  to.a = vertex.a;
  to.b = vertex.b;
  to.c = vertex.c;
  return to;
}
)";

void add_listings(std::vector<CostedShader>& shaders) {
  for (const ListingShader& listing : listing_shaders()) {
    shaders.push_back({std::string(listing.group), std::string(listing.name), "uniforms",
                       listing.published, pixel_shader(listing)});
  }
}

void add_model(std::vector<CostedShader>& shaders, const brdf::Model& model) {
  const auto add = [&](const MaterialFunction& function, ParameterSource source) {
    shaders.push_back({model.name(), function.path,
                       source == ParameterSource::uniforms ? "uniforms" : "literals", 0,
                       material_pixel_shader(function.text, source)});
  };
  for (const MaterialFunction& function : material_functions(model, {})) {
    // What addresses a table is in its function as numbers.
    if (!function.reads_table) add(function, ParameterSource::uniforms);
    add(function, ParameterSource::literals);
  }
}

}  // namespace

std::vector<CostedShader> costed_shaders() {
  std::vector<CostedShader> shaders;
  add_listings(shaders);
  shaders.push_back({"interface", "wi and wo alone", "", 0, empty_pixel_shader()});
  for (const std::string& name : brdf::model_names()) add_model(shaders, brdf::Model(name));
  return shaders;
}

ChipCosts shader_costs(const std::string& chip) {
  const shader::ChipCompiler compiler(chip);
  const auto vertex = shader::compile(vertex_shader, shader::Language::hlsl, shader::Stage::vertex);
  ChipCosts costs{compiler.device_text(), {}};
  for (CostedShader& shader : costed_shaders()) {
    const auto fragment =
        shader::compile(shader.hlsl, shader::Language::hlsl, shader::Stage::fragment);
    shader::InstructionCounts counts = compiler.count(vertex, fragment);
    costs.costs.push_back({std::move(shader), std::move(counts)});
  }
  return costs;
}

}  // namespace gonio::bench
