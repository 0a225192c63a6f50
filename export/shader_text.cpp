#include "export/shader_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "export/account.h"
#include "material/evaluate.h"
#include "shader/compose.h"

namespace gonio::exports {
namespace {

Exported to_shader(const material::Material& material, shader::Language language) {
  Exported exported;
  exported.fitted_as = "exact: the model itself, in float arithmetic";
  shader::SourceText text{.name = material.name, .header = origin_lines(material)};
  text.header.push_back(fmt::format("channels: {}", fmt::join(material.channels, ", ")));
  exported.files.push_back({"", shader::function_source(bind(material), language, text)});
  return exported;
}

}  // namespace

Exported to_hlsl(const material::Material& material) {
  return to_shader(material, shader::Language::hlsl);
}

Exported to_glsl(const material::Material& material) {
  return to_shader(material, shader::Language::glsl);
}

}  // namespace gonio::exports
