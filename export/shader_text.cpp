#include "export/shader_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "export/account.h"
#include "export/rgb.h"
#include "material/evaluate.h"
#include "shader/compose.h"

namespace gonio::exports {
namespace {

/// A colour's components are red, green and blue: three channels that are those come in this order.
/// Others stay as they are.
material::Material with_rgb_in_order(const material::Material& material) {
  const auto rgb = find_rgb_channels(material);
  if (!rgb || material.channels.size() != 3) return material;
  material::Material ordered = material;
  for (std::size_t c = 0; c < 3; ++c) ordered.channels[c] = material.channels[rgb->channel[c]];
  for (std::size_t p = 0; p < material.parameters.size(); ++p) {
    const std::vector<double>& value = material.parameters[p].value;
    if (value.size() != 3) continue;
    for (std::size_t c = 0; c < 3; ++c) ordered.parameters[p].value[c] = value[rgb->channel[c]];
  }
  return ordered;
}

Exported to_shader(const material::Material& original, shader::Language language) {
  const material::Material material = with_rgb_in_order(original);
  Exported exported;
  exported.fitted_as = fmt::format(
      "exact: the model itself; float arithmetic adds up to 5e-6 of the lobe's peak; channels {}",
      fmt::join(material.channels, ", "));
  shader::SourceText text{.name = material.name, .header = origin_lines(material)};
  text.header.push_back(fmt::format("stand-in: {}", exported.fitted_as));
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
