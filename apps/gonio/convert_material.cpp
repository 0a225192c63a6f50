// gonio convert MATERIAL: a fitted material as another model, such as the cheaper partner of a
// level-of-detail pair.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "apps/gonio/convert.h"
#include "brdf/model.h"
#include "material/material_json.h"

namespace gonio::app {
namespace {

using material::Conversion;

/// `--to`, where a bare term keeps the diffuse term that the material has.
brdf::Model target_in(const ConvertArguments& arguments, const material::Material& from) {
  if (arguments.to.empty()) {
    const auto lobe = lobe_material_of(from);
    return brdf::Model(lobe && lobe->lobe.term.ends_with("phong") ? "ward" : "blinn-phong");
  }
  return brdf::Model(arguments.to);
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
                    conversion.remaining.albedo, name(options.metric), conversion.metric_error));
  print(error_legend(options));
}

}  // namespace

void convert_material(const ConvertArguments& arguments, Invocation& invocation) {
  const material::Material from = material::read_material(arguments.source);
  const brdf::Model to = target_in(arguments, from);
  const material::ConversionOptions options = conversion_options_in(arguments);
  Conversion conversion = convert(from, to, options);
  set_provenance(conversion.material, arguments.source, invocation);
  if (arguments.json) {
    print_json(to_json(conversion.material));
  } else {
    print_conversion(from, conversion, options);
  }
  if (!arguments.output.empty()) write_material(conversion.material, arguments.output);
}

}  // namespace gonio::app
