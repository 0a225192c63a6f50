#include "export/mitsuba.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "export/account.h"
#include "export/mitsuba_lobe.h"
#include "export/mitsuba_ward.h"
#include "export/nearest_lobe.h"
#include "export/rgb.h"

namespace gonio::exports {
namespace {

/// A bsdf of Mitsuba as it will be written, and how far it is from the material.
struct Bsdf {
  std::string type;
  /// Everything within the tags of the outer bsdf, one element a line.
  std::vector<std::string> elements;
  std::string described;
  double tangent;
  material::Difference loss;
};

std::string rgb_element(std::string_view name, std::span<const double> rgb) {
  return fmt::format("<rgb name=\"{}\" value=\"{}, {}, {}\"/>", name, number_text(rgb[0]),
                     number_text(rgb[1]), number_text(rgb[2]));
}

std::string float_element(std::string_view name, double value) {
  return fmt::format("<float name=\"{}\" value=\"{}\"/>", name, number_text(value));
}

template <class Values>
void round_as_written(Values& values) {
  for (double& value : values) value = as_written(value);
}

template <class Lobe>
std::string described_values(std::string_view what, const LobeValues<Lobe>& values) {
  std::vector<std::string> named;
  for (std::size_t p = 0; p < values.size(); ++p) {
    named.push_back(fmt::format("{} {}", Lobe::parameters[p].name, number_text(values[p])));
  }
  return fmt::format("Mitsuba {}: {}", what, fmt::join(named, ", "));
}

/// The same lobe with the weight that makes the brightest component of the two nested reflectances
/// equal: no weight that keeps all reflectances at most 1 leaves more room.
template <class Values>
void balance_blend(Values& values) {
  const double of_diffuse =
      (1 - values[0]) * *std::max_element(values.begin() + 1, values.begin() + 4);
  const double of_specular = values[0] * *std::max_element(values.begin() + 4, values.begin() + 7);
  if (!(of_diffuse + of_specular > 0)) return;
  const double weight = of_specular / (of_diffuse + of_specular);
  for (std::size_t c = 1; c < 4; ++c) {
    values[c] = weight < 1 ? std::min(1.0, values[c] * (1 - values[0]) / (1 - weight)) : 0;
  }
  for (std::size_t c = 4; c < 7; ++c) {
    values[c] = weight > 0 ? std::min(1.0, values[c] * values[0] / weight) : 0;
  }
  values[0] = weight;
}

std::vector<std::string> conductor_elements(std::string_view distribution,
                                            std::span<const double> specular,
                                            std::span<const double> alpha) {
  std::vector<std::string> elements{
      fmt::format("<string name=\"distribution\" value=\"{}\"/>", distribution)};
  if (alpha.size() == 1) {
    elements.push_back(float_element("alpha", alpha[0]));
  } else {
    elements.push_back(float_element("alpha_u", alpha[0]));
    elements.push_back(float_element("alpha_v", alpha[1]));
  }
  elements.push_back(rgb_element("specular_reflectance", specular));
  return elements;
}

void append_nested(std::vector<std::string>& elements, std::string_view type, std::string_view name,
                   const std::vector<std::string>& nested) {
  elements.push_back(fmt::format("<bsdf type=\"{}\" name=\"{}\">", type, name));
  for (const std::string& element : nested) elements.push_back("  " + element);
  elements.emplace_back("</bsdf>");
}

/// The blend, or one of its two bsdfs alone where the other has no weight; `values` as those of
/// MitsubaBlend.
Bsdf blend_of(std::span<const double> values, std::string_view facets) {
  constexpr double no_weight = 1e-9;
  const std::vector<std::string> diffuse{rgb_element("reflectance", values.subspan(1, 3))};
  const auto conductor = conductor_elements(facets, values.subspan(4, 3), values.subspan(7));
  if (values[0] < no_weight) return {"diffuse", diffuse, "diffuse", 0, {}};
  const std::string rough = fmt::format("roughconductor ({})", facets);
  if (values[0] > 1 - no_weight) return {"roughconductor", conductor, rough, 0, {}};
  Bsdf bsdf{"blendbsdf",
            {float_element("weight", values[0])},
            fmt::format("blendbsdf of diffuse and {}", rough),
            0,
            {}};
  append_nested(bsdf.elements, "diffuse", "bsdf_0", diffuse);
  append_nested(bsdf.elements, "roughconductor", "bsdf_1", conductor);
  return bsdf;
}

template <Distribution distribution, bool anisotropic>
Bsdf nearest_blend(const RgbMaterial& rgb) {
  using Lobe = MitsubaBlend<distribution, anisotropic>;
  auto [values, tangent] = nearest_lobe<Lobe>(rgb.samples, rgb.tangents);
  balance_blend(values);
  round_as_written(values);
  Bsdf bsdf = blend_of(values, distribution == Distribution::ggx ? "ggx" : "beckmann");
  bsdf.tangent = tangent;
  bsdf.described = described_values<Lobe>(bsdf.described, values);
  bsdf.loss = material::difference(rgb.samples, lobe_reflectance<Lobe>(values, tangent));
  return bsdf;
}

template <bool anisotropic>
Bsdf nearest_principled(const RgbMaterial& rgb) {
  using Lobe = MitsubaPrincipled<anisotropic>;
  auto [values, tangent] = nearest_lobe<Lobe>(rgb.samples, rgb.tangents);
  round_as_written(values);
  Bsdf bsdf{"principled", {}, described_values<Lobe>("principled", values), tangent, {}};
  bsdf.elements.push_back(rgb_element("base_color", values));
  for (std::size_t p = 3; p < values.size(); ++p) {
    bsdf.elements.push_back(float_element(Lobe::parameters[p].name, values[p]));
  }
  bsdf.loss = material::difference(rgb.samples, lobe_reflectance<Lobe>(values, tangent));
  return bsdf;
}

template <bool anisotropic>
Bsdf nearest_of(const RgbMaterial& rgb) {
  std::array candidates{nearest_blend<Distribution::beckmann, anisotropic>(rgb),
                        nearest_blend<Distribution::ggx, anisotropic>(rgb),
                        nearest_principled<anisotropic>(rgb)};
  return *std::min_element(candidates.begin(), candidates.end(),
                           [](const Bsdf& a, const Bsdf& b) { return a.loss.rms < b.loss.rms; });
}

std::vector<std::string> warnings_about(const Bsdf& bsdf, bool anisotropic) {
  std::vector<std::string> warnings;
  if (anisotropic) {
    warnings.push_back(
        fmt::format("Mitsuba takes the tangent from a mesh's texture coordinates: u has to run {}",
                    bsdf.tangent == 0 ? std::string("along the material's x")
                                      : fmt::format("at {:.6g} deg from the table's x towards y",
                                                    bsdf.tangent * (180 / std::numbers::pi))));
  }
  return warnings;
}

/// A line for an XML comment, which may not hold two hyphens in a row nor end in one.
std::string comment_line(std::string text) {
  for (std::size_t i = 1; i < text.size(); ++i) {
    if (text[i - 1] == '-' && text[i] == '-') text.insert(i, " ");
  }
  return "  " + text + "\n";
}

std::string file_text(const RgbMaterial& rgb, const Bsdf& bsdf, const Exported& exported) {
  std::string text = "<!--\n";
  for (const std::string& line : account(rgb, exported)) text += comment_line(line);
  text += comment_line(
      "The bsdf is one-sided, like the material: black from behind. On a mesh "
      "that is no closed solid, nest it in a bsdf of type twosided.");
  for (const std::string& line : mitsuba_06_ward(rgb)) text += comment_line(line);
  text += fmt::format("-->\n<scene version=\"3.0.0\">\n  <bsdf type=\"{}\" id=\"{}\">\n", bsdf.type,
                      plain_name(rgb.material->name));
  for (const std::string& element : bsdf.elements) text += "    " + element + "\n";
  return text + "  </bsdf>\n</scene>\n";
}

}  // namespace

Exported to_mitsuba(const material::Material& material) {
  const RgbMaterial rgb = rgb_material(material);
  const bool anisotropic = rgb.model.model().is_anisotropic();
  const Bsdf bsdf = anisotropic ? nearest_of<true>(rgb) : nearest_of<false>(rgb);
  Exported exported{
      .files = {},
      .loss = bsdf.loss,
      .fitted_as = (is_exact(bsdf.loss) ? "exact: " : "") + bsdf.described,
      .warnings = warnings_about(bsdf, anisotropic),
  };
  add_warnings(rgb, exported);
  exported.files.push_back({"", file_text(rgb, bsdf, exported)});
  return exported;
}

}  // namespace gonio::exports
