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

/// A table that a display shows.
void add_warning_of_table(Exported& exported) {
  constexpr double half_step = 1.0 / 510;  // of 8 bits that show the brightest radiance as white
  if (exported.loss.peak <= half_step) return;
  exported.warnings.push_back(fmt::format(
      "the table's error, {:.2g} of the brightest radiance, is more than half a step of "
      "8 bits: gonio lut check --recommend looks for a better one",
      exported.loss.peak));
}

Exported to_shader_with_table(const material::Material& original, const ShaderTable& table,
                              shader::Language language) {
  const material::Material material = with_rgb_in_order(original);
  const brdf::BoundModel model = bind(material);
  const lut::Layout& layout = table.table.layout;
  Exported exported;
  exported.loss = table_loss(model, material.channels, table.table);
  exported.fitted_as = fmt::format(
      "the model with {} read from {}; float arithmetic adds up to {} of the lobe's peak; "
      "channels {}",
      lut::name_of(layout.kind), table.file,
      layout.coordinate == lut::Coordinate::listing ? "1e-4" : "1e-5",
      fmt::join(material.channels, ", "));
  add_warning_of_table(exported);
  shader::SourceText text{.name = material.name, .header = origin_lines(material)};
  for (const std::string& line : texture_lines(table)) text.header.push_back(line);
  text.header.push_back(fmt::format("stand-in: {}", exported.fitted_as));
  text.header.push_back(fmt::format("loss of reflected radiance: {}", loss_text(exported.loss)));
  for (const std::string& warning : exported.warnings) {
    text.header.push_back(fmt::format("warning: {}", warning));
  }
  exported.files.push_back({"", shader::function_source(model, table.table, language, text)});
  return exported;
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

Exported to_hlsl_with_table(const material::Material& material, const ShaderTable& table) {
  return to_shader_with_table(material, table, shader::Language::hlsl);
}

Exported to_glsl_with_table(const material::Material& material, const ShaderTable& table) {
  return to_shader_with_table(material, table, shader::Language::glsl);
}

}  // namespace gonio::exports
