#include "export/target.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "brdf/nearest_name.h"
#include "export/gltf.h"
#include "export/material_file.h"
#include "export/mitsuba.h"
#include "export/openmaterial.h"
#include "export/radiance.h"
#include "export/shader_text.h"

namespace gonio::exports {
namespace {

/// A target of one file, which needs no name of it.
template <Exported (*write)(const material::Material&)>
Exported single_file(const material::Material& material, const std::string& /*stem*/) {
  return write(material);
}

Exported openmaterial(const material::Material& material, const std::string& stem) {
  return to_openmaterial(material, stem);
}

}  // namespace

std::span<const Target> all_targets() {
  static const std::array targets{
      Target{"gltf", ".gltf",
             "glTF 2.0: metallic-roughness with KHR_materials_anisotropy, _ior and _specular",
             single_file<to_gltf>},
      Target{"glsl", ".glsl", "a function for GLSL 4.50 and ES 3.00 with the parameters in it",
             single_file<to_glsl>, to_glsl_with_table},
      Target{"hlsl", ".hlsl", "a function for HLSL with the parameters in it", single_file<to_hlsl>,
             to_hlsl_with_table},
      Target{"json", ".json", "the material file of gonio itself, to the last bit",
             single_file<to_material_file>},
      Target{"mitsuba", ".xml", "Mitsuba 3: a bsdf of the nearest plugins",
             single_file<to_mitsuba>},
      Target{"openmaterial", ".xomp",
             "ASAM OpenMATERIAL 3D: a material file and a table of its reflectance", openmaterial},
      Target{"radiance", ".rad", "Radiance: plastic or metal, or their anisotropic forms",
             single_file<to_radiance>},
  };
  return targets;
}

const Target& target_named(const std::string& name) {
  const auto targets = all_targets();
  const auto found =
      std::find_if(targets.begin(), targets.end(), [&](const Target& t) { return t.name == name; });
  if (found != targets.end()) return *found;
  std::vector<std::string> names;
  for (const Target& target : targets) names.push_back(target.name);
  const std::optional<std::string_view> nearest = brdf::nearest_name(name, names);
  throw std::invalid_argument(fmt::format(
      "unknown target '{}'{}; there are {}", name,
      nearest ? fmt::format(", did you mean '{}'?", *nearest) : "", fmt::join(names, ", ")));
}

}  // namespace gonio::exports
