// What a project that uses gonio's shaders looks like: a material's function as GLSL, and the
// compute shader around it as SPIR-V.
#include <cstdio>
#include <vector>

#include "shader/compose.h"
#include "shader/spirv.h"

int main() {
  using gonio::shader::Language;
  const std::vector<double> white{1};
  const std::vector<gonio::brdf::NamedValues> parameters{{"rho_d", white}};
  const gonio::brdf::BoundModel lambert(gonio::brdf::Model("lambert"), 1, parameters);
  const gonio::shader::SourceText text{"white", {}};
  std::puts(gonio::shader::function_source(lambert, Language::glsl, text).c_str());
  const auto kernel = gonio::shader::evaluation_kernel(lambert, Language::hlsl, text);
  return gonio::shader::compile(kernel, Language::hlsl).empty() ? 1 : 0;
}
