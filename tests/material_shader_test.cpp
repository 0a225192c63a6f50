// The pixel shader around a material's function, which bench/shader_cost counts: where its
// parameters are uniforms, all of them are.
#include "bench/material_shader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "bench/material_functions.h"
#include "bench/shader_materials.h"
#include "shader/term_source.h"

namespace gonio::tests {
namespace {

/// How many constants evaluating the model in three channels takes.
std::size_t constants_of(const brdf::Model& model) {
  std::size_t count = 0;
  for (const brdf::TermEntry* term : model.terms()) {
    const shader::TermSource& source = shader::term_source(*term);
    const std::vector<double> any(term->shape.size(), 0.5);
    count += shader::shape_constants(*term, source, any, "").size();
    count += term->basis_size -
             std::size_t(std::count(source.coefficients.begin(), source.coefficients.end(), ""));
  }
  return count;
}

/// How many uniforms the shader declares.
std::size_t uniforms_of(const std::string& pixel_shader) {
  const std::size_t begin = pixel_shader.find("cbuffer Material : register(b0) {");
  if (begin == std::string::npos) return 0;
  const std::size_t end = pixel_shader.find('}', begin);
  const std::string_view buffer = std::string_view(pixel_shader).substr(begin, end - begin);
  return std::size_t(std::count(buffer.begin(), buffer.end(), ';'));
}

TEST(MaterialShader, HasEveryConstantOfTheModelAsAUniform) {
  for (const brdf::Model& model : bench::shader_models()) {
    const std::string function = bench::material_functions(model, {}).front().text;
    EXPECT_EQ(uniforms_of(bench::material_pixel_shader(function, bench::ParameterSource::uniforms)),
              constants_of(model))
        << model.name();
    EXPECT_EQ(uniforms_of(bench::material_pixel_shader(function, bench::ParameterSource::literals)),
              0U);
    EXPECT_GT(constants_of(model), 0U) << model.name();
  }
}

TEST(MaterialShader, RefusesAFunctionInWhichItDoesNotFindTheParameters) {
  const std::string head = "float3 brdf_material(float3 wi, float3 wo) {\n";
  const std::string parameter = "  const float3 rho_d = float3(0.5, 0.4, 0.3);\n";
  const std::string indented_otherwise = "    const float3 rho_s = float3(0.5, 0.4, 0.3);\n";
  const auto with_uniforms = [](const std::string& function) {
    return bench::material_pixel_shader(function, bench::ParameterSource::uniforms);
  };
  EXPECT_NO_THROW(with_uniforms(head + parameter + "  return rho_d;\n}\n"));
  EXPECT_THROW(with_uniforms(head + "  return float3(0.5, 0.4, 0.3);\n}\n"), std::invalid_argument);
  EXPECT_THROW(with_uniforms(head + parameter + indented_otherwise + "  return rho_d;\n}\n"),
               std::invalid_argument);
  EXPECT_THROW(with_uniforms("float brdf_material(float3 wi, float3 wo) {\n" + parameter + "}\n"),
               std::invalid_argument);
}

}  // namespace
}  // namespace gonio::tests
