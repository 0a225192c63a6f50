// gonio convert MATERIAL: a fitted material as another model, such as the cheaper partner of a
// level-of-detail pair.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "apps/gonio/convert.h"
#include "brdf/model.h"
#include "material/evaluate.h"
#include "material/material_json.h"

namespace gonio::app {
namespace {

using material::Conversion;

/// `--to`, where a bare specular term keeps the diffuse term that the material has.
brdf::Model target_in(const ConvertArguments& arguments, const material::Material& from) {
  const brdf::Model model = model_of(from);
  const auto lobe = lobe_material_of(from);
  const std::string to = arguments.to.empty()
                             ? (lobe ? default_target(lobe->lobe.term) : "blinn-phong")
                             : arguments.to;
  const brdf::TermEntry& diffuse = *model.terms().front();
  brdf::Model given(to);
  const bool is_bare = to.find('+') == std::string::npos && given.terms().size() == 2;
  if (!is_bare || diffuse.description.kind != brdf::TermKind::diffuse) return given;
  return brdf::Model(std::string(diffuse.description.name) + "+" + to);
}

std::string parameters_of(const material::Material& material) {
  std::string text;
  for (const material::ParameterValue& p : material.parameters) {
    std::vector<std::string> values;
    for (const double value : p.value) values.push_back(fmt::format("{:.6g}", value));
    text += fmt::format("  {:<10} {}\n", p.name, fmt::join(values, "  "));
  }
  return text;
}

void print_conversion(const material::Material& from, const Conversion& conversion,
                      const material::ConversionOptions& options) {
  print(fmt::format("{}: {}\n{}\nas {} ({}; channels {})\n{}\n",
                    from.name.empty() ? "material" : from.name, from.model, parameters_of(from),
                    conversion.material.model, name(options.method), fmt::join(from.channels, ", "),
                    parameters_of(conversion.material)));
  print(fmt::format("  peak {}, rms {}, albedo {:.3g}, {} error {:.6g}\n\n",
                    percent(conversion.remaining.peak), percent(conversion.remaining.rms),
                    conversion.remaining.albedo, name(options.metric),
                    conversion.material.conversion->metric_error));
}

/// The Ks of a highlight that a shader draws without the cosine of the incidence.
std::string classic_amplitudes(const material::Material& material) {
  const material::Lobe lobe = lobe_material_of(material)->lobe;
  std::string text;
  for (const double ks : lobe.amplitudes) {
    text += fmt::format(" {:.6g}",
                        material::amplitude_in(material::Amplitude::classic, ks, lobe.shape));
  }
  return fmt::format("  Ks (classic, without the cosine of the incidence){}\n\n", text);
}

}  // namespace

void convert_material(const ConvertArguments& arguments, Invocation& invocation) {
  refuse_overwriting(arguments.source, arguments.output);
  const material::Material from = material::read_material(arguments.source);
  const brdf::Model to = target_in(arguments, from);
  material::ConversionOptions options = conversion_options_in(arguments);
  options.to_classic = wants_classic(arguments);
  if (options.to_classic && (arguments.json || !arguments.output.empty())) {
    throw std::invalid_argument(
        "--amplitude classic: a highlight without the cosine is no material of gonio: leave -o and "
        "--json out, its Ks is printed");
  }
  Conversion conversion = convert(from, to, options);
  set_provenance(conversion.material, source_file(arguments.source), invocation);
  if (arguments.json) {
    print_json(to_json(conversion.material));
  } else {
    print_conversion(from, conversion, options);
    if (options.to_classic) print(classic_amplitudes(conversion.material));
    print(error_legend(options));
  }
  if (!arguments.output.empty()) write_material(conversion.material, arguments.output);
}

}  // namespace gonio::app
