#include "export/radiance.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "export/account.h"
#include "export/nearest_lobe.h"
#include "export/radiance_lobe.h"
#include "export/rgb.h"

namespace gonio::exports {
namespace {

/// A material of Radiance as it will be written.
struct Primitive {
  std::string_view type;
  std::vector<std::string_view> names;
  std::vector<double> arguments;
  double tangent;  // azimuth of u in radians
  bool has_tangent;
  material::Difference loss;
};

template <class Lobe>
Primitive nearest(std::string_view type, const RgbMaterial& rgb) {
  auto [values, tangent] = nearest_lobe<Lobe>(rgb.samples, rgb.tangents);
  for (double& value : values) value = as_written(value);
  Primitive primitive{type, {}, {}, tangent, values.size() == 6, {}};
  for (const LobeParameter& parameter : Lobe::parameters) primitive.names.push_back(parameter.name);
  primitive.arguments.assign(values.begin(), values.end());
  primitive.loss = material::difference(rgb.samples, lobe_reflectance<Lobe>(values, tangent));
  return primitive;
}

Primitive with_smaller_loss(Primitive a, Primitive b) {
  return b.loss.rms < a.loss.rms - exact_difference ? std::move(b) : std::move(a);
}

Primitive best_anisotropic(const RgbMaterial& rgb) {
  return with_smaller_loss(nearest<RadiancePlastic2>("plastic2", rgb),
                           nearest<RadianceMetal2>("metal2", rgb));
}

Primitive best_primitive(const RgbMaterial& rgb) {
  if (rgb.model.model().is_anisotropic()) return best_anisotropic(rgb);
  const Primitive best = with_smaller_loss(nearest<RadiancePlastic>("plastic", rgb),
                                           nearest<RadianceMetal>("metal", rgb));
  // The anisotropic forms, with the same roughness twice, have narrower lobes.
  const bool is_as_narrow_as_can_be =
      best.arguments[4] <= RadiancePlastic::least_roughness * (1 + 1e-9);
  return is_as_narrow_as_can_be ? with_smaller_loss(best, best_anisotropic(rgb)) : best;
}

std::string described(const Primitive& primitive) {
  std::vector<std::string> parameters;
  for (std::size_t p = 0; p < primitive.arguments.size(); ++p) {
    parameters.push_back(
        fmt::format("{} {}", primitive.names[p], number_text(primitive.arguments[p])));
  }
  return fmt::format("{}Radiance {}: {}", is_exact(primitive.loss) ? "exact: " : "", primitive.type,
                     fmt::join(parameters, ", "));
}

std::vector<std::string> warnings_about(const Primitive& primitive, bool anisotropic) {
  std::vector<std::string> warnings;
  const std::vector<double>& arguments = primitive.arguments;
  const double colour = std::max({arguments[0], arguments[1], arguments[2]});
  const double specularity = arguments[3];
  const double most = std::max(arguments[4], arguments.back());
  if (colour > 1) {
    warnings.push_back(fmt::format(
        "a colour of {} is above 1: the surface reflects more than it receives", colour));
  }
  if (specularity > 0.1 && primitive.type.substr(0, 7) == "plastic") {
    warnings.push_back(
        fmt::format("a specularity of {} is above 0.1, which Radiance's manual calls not very "
                    "realistic for plastic",
                    specularity));
  }
  if (specularity > 0 && most > 0.2) {
    warnings.push_back(fmt::format(
        "a roughness of {} is above 0.2, which Radiance's manual calls not very realistic", most));
  }
  if (anisotropic) {
    warnings.emplace_back(
        "u is a direction of the scene: it is the tangent for a surface in the xy plane whose "
        "normal is z, and has to be turned with the surface (a transform may follow the '.')");
  }
  return warnings;
}

std::string primitive_text(const Primitive& primitive, const std::string& name) {
  std::vector<std::string> numbers;
  for (const double argument : primitive.arguments) numbers.push_back(number_text(argument));
  const std::string orientation =
      primitive.has_tangent ? fmt::format("4 {} {} 0 .", number_text(std::cos(primitive.tangent)),
                                          number_text(std::sin(primitive.tangent)))
                            : "0";
  return fmt::format("void {} {}\n{}\n0\n{} {}\n", primitive.type, name, orientation,
                     numbers.size(), fmt::join(numbers, " "));
}

}  // namespace

Exported to_radiance(const material::Material& material) {
  const RgbMaterial rgb = rgb_material(material);
  const Primitive primitive = best_primitive(rgb);
  Exported exported{
      .files = {},
      .loss = primitive.loss,
      .fitted_as = described(primitive),
      .warnings = warnings_about(primitive, rgb.model.model().is_anisotropic()),
  };
  add_warnings(rgb, exported);
  std::string text;
  for (const std::string& line : account(rgb, exported)) text += "# " + line + "\n";
  text += "\n" + primitive_text(primitive, plain_name(material.name));
  exported.files.push_back({"", std::move(text)});
  return exported;
}

}  // namespace gonio::exports
