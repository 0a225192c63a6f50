#include "export/mitsuba_ward.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace gonio::exports {
namespace {

/// The variant of the plugin that is our model of that name.
std::optional<std::string_view> variant_of(std::string_view model) {
  constexpr std::array<std::array<std::string_view, 2>, 6> variants{
      {{"lambert+ward", "ward"},
       {"lambert+ward-aniso", "ward"},
       {"lambert+ward-duer", "ward-duer"},
       {"lambert+ward-duer-aniso", "ward-duer"},
       {"lambert+ward-gmd", "balanced"},
       {"lambert+ward-gmd-aniso", "balanced"}}};
  for (const auto& [name, variant] : variants) {
    if (name == model) return variant;
  }
  return {};
}

/// The values of a parameter; empty if the material has none of that name.
std::vector<double> values_of(const material::Material& material, std::string_view name) {
  const auto found =
      std::find_if(material.parameters.begin(), material.parameters.end(),
                   [&](const material::ParameterValue& p) { return p.name == name; });
  return found == material.parameters.end() ? std::vector<double>{} : found->value;
}

std::string rgb_element(std::string_view name, const std::vector<double>& values,
                        const RgbChannels& channels) {
  return fmt::format("  <rgb name=\"{}\" value=\"{}, {}, {}\"/>", name, values[channels.channel[0]],
                     values[channels.channel[1]], values[channels.channel[2]]);
}

}  // namespace

std::vector<std::string> mitsuba_06_ward(const RgbMaterial& material) {
  const auto variant = variant_of(material.model.model().name());
  if (!variant) return {};
  const auto of = [&](std::string_view name) { return values_of(*material.material, name); };
  const bool anisotropic = material.model.model().is_anisotropic();
  constexpr std::string_view heading =
      "Mitsuba 0.6 holds the model exactly (if no channel's two reflectances add up to more than "
      "1, which it scales down):";
  return {
      std::string(heading),
      "<bsdf type=\"ward\">",
      fmt::format("  <string name=\"variant\" value=\"{}\"/>", *variant),
      fmt::format("  <float name=\"alphaU\" value=\"{}\"/>",
                  of(anisotropic ? "alpha_x" : "alpha")[0]),
      fmt::format("  <float name=\"alphaV\" value=\"{}\"/>",
                  of(anisotropic ? "alpha_y" : "alpha")[0]),
      rgb_element("diffuseReflectance", of("rho_d"), material.channels),
      rgb_element("specularReflectance", of("rho_s"), material.channels),
      "</bsdf>",
  };
}

}  // namespace gonio::exports
