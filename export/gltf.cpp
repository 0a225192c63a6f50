#include "export/gltf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "export/account.h"
#include "export/gltf_lobe.h"
#include "export/nearest_lobe.h"
#include "export/rgb.h"
#include "material/material_json.h"

namespace gonio::exports {
namespace {

using Json = nlohmann::ordered_json;
using Rgb = std::array<double, 3>;

/// The properties of a glTF material, under their names there.
struct Properties {
  Rgb base_color;
  double metallic;
  double roughness;
  double ior;
  double specular;
  Rgb specular_color;
  double anisotropy_strength;
  double anisotropy_rotation;  // radians
};

/// The index of refraction of a dielectric that reflects `f0` at normal incidence, as far as such
/// materials exist (diamond: 2.4); a specular colour above 1 does the rest.
double index_of(double f0) {
  constexpr double largest = 2.5;
  const double root = std::sqrt(f0);
  return root < 1 ? std::min(largest, (1 + root) / (1 - root)) : largest;
}

double f0_of(double index) {
  const double ratio = (index - 1) / (index + 1);
  return ratio * ratio;
}

void set_dielectric(Properties& properties, const Rgb& f0) {
  const double largest = std::max({f0[0], f0[1], f0[2]});
  if (!(largest > 0)) {
    properties.specular_color = {0, 0, 0};
    return;
  }
  properties.ior = as_written(index_of(largest));
  for (std::size_t c = 0; c < 3; ++c) {
    properties.specular_color[c] = as_written(f0[c] / f0_of(properties.ior));
  }
}

/// A colour of a fit whose channel `brightest` stood first: the channels in their order, and for a
/// material of one channel, where nothing tells them apart, their mean.
Rgb colour_of(Rgb fitted, const RgbMaterial& rgb, std::size_t brightest) {
  std::swap(fitted[0], fitted[brightest]);
  if (rgb.material->channels.size() == 1) {
    fitted.fill((fitted[0] + fitted[1] + fitted[2]) / 3);
  }
  for (double& value : fitted) value = as_written(value);
  return fitted;
}

template <bool anisotropic>
Properties properties_of(const NearestLobe<GltfLobe<anisotropic>>& nearest, const RgbMaterial& rgb,
                         std::size_t brightest) {
  constexpr double default_ior = 1.5;
  const auto& [values, tangent] = nearest;
  const GltfSurface<double> surface = GltfLobe<anisotropic>::surface(values);
  Properties properties{
      .base_color = colour_of(surface.base_color, rgb, brightest),
      .metallic = as_written(values[3]),
      .roughness = as_written(values[4]),
      .ior = default_ior,
      .specular = as_written(values[5]),
      .specular_color = {},
      .anisotropy_strength = 0,
      .anisotropy_rotation = as_written(tangent),
  };
  set_dielectric(properties, colour_of(surface.f0, rgb, brightest));
  if constexpr (anisotropic) properties.anisotropy_strength = as_written(values[9]);
  return properties;
}

/// What a reader of the properties evaluates.
material::Reflectance reflectance_of(const Properties& properties) {
  GltfSurface<double> surface{.base_color = properties.base_color,
                              .metallic = properties.metallic,
                              .specular = properties.specular,
                              .f0 = {},
                              .largest_f0 = 0,
                              .alpha_along = 0,
                              .alpha_across = properties.roughness * properties.roughness};
  for (std::size_t c = 0; c < 3; ++c) {
    surface.f0[c] = std::min(1.0, f0_of(properties.ior) * properties.specular_color[c]);
  }
  surface.largest_f0 = *std::max_element(surface.f0.begin(), surface.f0.end());
  const double strength = properties.anisotropy_strength;
  surface.alpha_along = std::lerp(surface.alpha_across, 1.0, strength * strength);
  const double tangent = properties.anisotropy_rotation;
  return [surface, tangent](const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                            std::span<double> f_r) {
    std::array<double, 3> rgb{};
    if (brdf::above_horizon(wi, wo)) {
      rgb = gltf_f_r(surface, from_tangent(wi, tangent), from_tangent(wo, tangent));
    }
    std::copy(rgb.begin(), rgb.end(), f_r.begin());
  };
}

/// The channel whose f_r varies most: the one with the strongest highlight.
std::size_t brightest_highlight(const table::SampleTable& samples) {
  const table::SampleFilter is_compared(samples, material::largest_compared_theta_deg);
  std::array<double, 3> ranges{};
  for (std::size_t c = 0; c < 3; ++c) {
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!is_compared(i)) continue;
      least = std::min(least, samples.values[c][i]);
      most = std::max(most, samples.values[c][i]);
    }
    ranges[c] = most - least;
  }
  return std::size_t(std::max_element(ranges.begin(), ranges.end()) - ranges.begin());
}

template <bool anisotropic>
Properties nearest(const RgbMaterial& rgb) {
  std::vector<double> tangents = rgb.tangents;
  if constexpr (anisotropic) {
    // The rougher direction is the tangent in glTF; which one it is the fit finds.
    for (const double tangent : rgb.tangents) tangents.push_back(tangent + std::numbers::pi / 2);
  }
  const std::size_t brightest = brightest_highlight(rgb.samples);
  table::SampleTable samples = rgb.samples;
  std::swap(samples.values[0], samples.values[brightest]);
  return properties_of<anisotropic>(nearest_lobe<GltfLobe<anisotropic>>(samples, tangents), rgb,
                                    brightest);
}

std::string rgb_text(const Rgb& rgb) {
  return fmt::format("({}, {}, {})", number_text(rgb[0]), number_text(rgb[1]), number_text(rgb[2]));
}

std::string described(const Properties& properties, bool anisotropic) {
  std::string text = fmt::format(
      "glTF metallic-roughness: baseColorFactor {}, metallicFactor {}, roughnessFactor {}, ior {}, "
      "specularFactor {}, specularColorFactor {}",
      rgb_text(properties.base_color), number_text(properties.metallic),
      number_text(properties.roughness), number_text(properties.ior),
      number_text(properties.specular), rgb_text(properties.specular_color));
  if (anisotropic) {
    text += fmt::format(", anisotropyStrength {}, anisotropyRotation {}",
                        number_text(properties.anisotropy_strength),
                        number_text(properties.anisotropy_rotation));
  }
  return text;
}

Json extensions_json(const Properties& properties, bool anisotropic) {
  Json extensions;
  extensions["KHR_materials_ior"] = {{"ior", properties.ior}};
  extensions["KHR_materials_specular"] = {{"specularFactor", properties.specular},
                                          {"specularColorFactor", properties.specular_color}};
  if (anisotropic) {
    extensions["KHR_materials_anisotropy"] = {
        {"anisotropyStrength", properties.anisotropy_strength},
        {"anisotropyRotation", properties.anisotropy_rotation}};
  }
  return extensions;
}

Json loss_json(const material::Difference& loss) {
  return {{"peak", loss.peak},
          {"peak_at",
           {{"theta_i_deg", loss.where.theta_i_deg},
            {"theta_o_deg", loss.where.theta_o_deg},
            {"channel", loss.where.channel}}},
          {"rms", loss.rms},
          {"albedo", loss.albedo}};
}

Json extras_json(const RgbMaterial& rgb, const Exported& exported) {
  return {{"gonio",
           {{"model", rgb.model.model().name()},
            {"channels", rgb.material->channels},
            {"parameters", material::to_json(*rgb.material)["parameters"]},
            {"loss", loss_json(exported.loss)},
            {"account", account(rgb, exported)}}}};
}

Json asset_json(const RgbMaterial& rgb, const Properties& properties, const Exported& exported) {
  const bool anisotropic = rgb.model.model().is_anisotropic();
  const Json extensions = extensions_json(properties, anisotropic);
  Json used = Json::array();
  for (const auto& [name, extension] : extensions.items()) used.push_back(name);
  Json material;
  material["name"] = rgb.material->name;
  material["pbrMetallicRoughness"] = {
      {"baseColorFactor",
       {properties.base_color[0], properties.base_color[1], properties.base_color[2], 1}},
      {"metallicFactor", properties.metallic},
      {"roughnessFactor", properties.roughness}};
  material["extensions"] = extensions;
  material["extras"] = extras_json(rgb, exported);
  Json asset;
  asset["asset"] = {{"version", "2.0"}, {"generator", fmt::format("gonio {}", GONIO_VERSION)}};
  asset["extensionsUsed"] = used;
  asset["materials"] = Json::array({material});
  return asset;
}

}  // namespace

Exported to_gltf(const material::Material& material) {
  const RgbMaterial rgb = rgb_material(material);
  const bool anisotropic = rgb.model.model().is_anisotropic();
  const Properties properties = anisotropic ? nearest<true>(rgb) : nearest<false>(rgb);
  Exported exported{
      .files = {},
      .loss = material::difference(rgb.samples, reflectance_of(properties)),
      .fitted_as = described(properties, anisotropic),
      .warnings = {},
  };
  if (is_exact(exported.loss)) exported.fitted_as = "exact: " + exported.fitted_as;
  if (anisotropic) {
    exported.warnings.emplace_back(
        "glTF takes the tangent from the mesh: it needs tangents, or texture coordinates and a "
        "normal texture, whose tangent is the table's x");
  }
  add_warnings(rgb, exported);
  const Json asset = asset_json(rgb, properties, exported);
  exported.files = {{"", asset.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"}};
  return exported;
}

}  // namespace gonio::exports
