#include "material/conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "material/evaluate.h"
#include "material/nearest_model.h"

namespace gonio::material {
namespace {

constexpr std::string_view lambert_plus = "lambert+";

std::vector<fit::ParameterSetting> settings_of(const ParameterValue& parameter,
                                               std::span<const std::string> channels,
                                               bool per_channel) {
  if (!per_channel) return {{parameter.name, parameter.value.front()}};
  std::vector<fit::ParameterSetting> settings;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    settings.push_back({parameter.name + "." + channels[c], parameter.value[c]});
  }
  return settings;
}

/// Every parameter of a material as it is.
std::vector<fit::ParameterSetting> all_settings(const Material& material) {
  const brdf::Model model = model_of(material);
  std::vector<fit::ParameterSetting> settings;
  for (const ParameterValue& parameter : material.parameters) {
    const auto amplitudes = model.amplitudes();
    const bool per_channel =
        std::any_of(amplitudes.begin(), amplitudes.end(),
                    [&](const brdf::ModelParameter& a) { return a.name == parameter.name; });
    const auto more = settings_of(parameter, material.channels, per_channel);
    settings.insert(settings.end(), more.begin(), more.end());
  }
  return settings;
}

const ParameterValue& parameter_of(const Material& material, std::string_view name) {
  return *std::find_if(material.parameters.begin(), material.parameters.end(),
                       [&](const ParameterValue& p) { return p.name == name; });
}

/// The parameters of the diffuse term that both models begin with; none if they differ.
std::vector<fit::ParameterSetting> shared_diffuse(const Material& from, const brdf::Model& to) {
  const brdf::Model model = model_of(from);
  const brdf::TermEntry* diffuse = model.terms().front();
  if (diffuse != to.terms().front() || diffuse->description.kind != brdf::TermKind::diffuse) {
    return {};
  }
  std::vector<fit::ParameterSetting> settings;
  for (const brdf::Parameter& p : diffuse->amplitudes) {
    const auto more = settings_of(parameter_of(from, p.name), from.channels, true);
    settings.insert(settings.end(), more.begin(), more.end());
  }
  for (const brdf::Parameter& p : diffuse->shape) {
    settings.push_back({std::string(p.name), parameter_of(from, p.name).value.front()});
  }
  return settings;
}

/// The reflectance of a Lambert material with a lobe that lacks the cosine of the incidence: the
/// diffuse part and the lobe are two materials.
struct ClassicReflectance {
  brdf::BoundModel diffuse;
  brdf::BoundModel lobe;

  void operator()(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                  std::span<double> values) const {
    std::vector<double> specular(values.size());
    diffuse.f_r(wi, wo, values);
    lobe.f_r(wi, wo, specular);
    if (!(wi.z > 0)) return;
    for (std::size_t c = 0; c < values.size(); ++c) values[c] += specular[c] / wi.z;
  }
};

Reflectance classic_reflectance(const LobeMaterial& from) {
  const std::vector<double> black(from.channels.size());
  Lobe dark = from.lobe;
  dark.amplitudes = black;
  return ClassicReflectance{bind(material_of(dark, from.rho_d, from.channels)),
                            bind(material_of(from.lobe, black, from.channels))};
}

fit::Metric require_usable(fit::Metric metric) {
  if (metric != fit::Metric::chi2) return metric;
  throw std::invalid_argument(
      "metric chi2 needs the noise of a measurement, and a conversion has none; use cosine-l2, l2, "
      "log, cube-root or relative");
}

/// What the two ways of converting share: judging the result and saying where it comes from.
Conversion judged(NearestMaterial nearest, const table::SampleTable& samples,
                  const ConversionOptions& options) {
  const brdf::BoundModel stand_in = bind(nearest.material);
  Conversion conversion{.material = std::move(nearest.material),
                        .metric_error = nearest.metric_error,
                        .remaining = difference(samples, reflectance_of(stand_in))};
  conversion.material.conversion = ConversionRecord{.from = {},
                                                    .method = std::string(name(options.method)),
                                                    .metric = std::string(name(options.metric)),
                                                    .peak = conversion.remaining.peak,
                                                    .rms = conversion.remaining.rms,
                                                    .albedo = conversion.remaining.albedo};
  return conversion;
}

/// The closed form as it is.
NearestMaterial with_error(Material material, const table::SampleTable& samples,
                           fit::Metric metric) {
  const auto all = all_settings(material);
  const double error = nearest_material(samples, model_of(material), metric, all).metric_error;
  return {std::move(material), error};
}

/// The shape parameters of a closed form, as a place to start from.
std::vector<fit::ParameterSetting> start_at(const LobeMaterial& from, std::string_view to) {
  try {
    const Lobe lobe = closed_form({from.lobe.term, from.lobe.shape, {}}, to);
    const Material material = material_of(lobe, {}, {});
    const ParameterValue& shape = material.parameters.back();
    return {{shape.name, shape.value.front()}};
  } catch (const std::invalid_argument&) {
    return {};
  }
}

std::string in_words(const LobeMaterial& from) {
  const Material material = material_of(from.lobe, from.rho_d, from.channels);
  const ParameterValue& shape = material.parameters.back();
  return fmt::format("{}, {} {:.6g}{}", from.lobe.term, shape.name, shape.value.front(),
                     from.is_classic ? ", without the cosine of the incidence" : "");
}

}  // namespace

std::string_view name(ConversionMethod method) {
  return method == ConversionMethod::closed_form ? "closed-form" : "best-fit";
}

ConversionMethod conversion_method_from_name(std::string_view text) {
  for (const auto method : {ConversionMethod::closed_form, ConversionMethod::best_fit}) {
    if (text == name(method)) return method;
  }
  throw std::invalid_argument(
      fmt::format("there is no method '{}'; there are closed-form and best-fit", text));
}

Conversion convert(const LobeMaterial& from, std::string_view to,
                   const ConversionOptions& options) {
  const fit::Metric metric = require_usable(options.metric);
  const Material original = material_of(from.lobe, from.rho_d, from.channels);
  const brdf::BoundModel bound = bind(original);
  const brdf::Model target(std::string(lambert_plus) + std::string(to));
  const table::SampleTable samples =
      sample(from.is_classic ? classic_reflectance(from) : reflectance_of(bound), from.channels,
             options.incidence.value_or(default_incidence(target)));
  NearestMaterial nearest =
      options.method == ConversionMethod::closed_form
          ? with_error(material_of(closed_form(from.lobe, to), from.rho_d, from.channels), samples,
                       metric)
          : nearest_material(samples, target, metric, shared_diffuse(original, target),
                             start_at(from, to));
  Conversion conversion = judged(std::move(nearest), samples, options);
  conversion.material.name = from.name;
  conversion.material.conversion->from = in_words(from);
  return conversion;
}

std::optional<LobeMaterial> lobe_material_of(const Material& material) {
  if (!material.model.starts_with(lambert_plus)) return std::nullopt;
  const std::string term = material.model.substr(lambert_plus.size());
  const auto terms = convertible_terms();
  if (std::find(terms.begin(), terms.end(), term) == terms.end()) return std::nullopt;
  // In the model's order: rho_d, the lobe's amplitude, its shape.
  return LobeMaterial{.name = material.name,
                      .channels = material.channels,
                      .rho_d = material.parameters[0].value,
                      .lobe = {.term = term,
                               .shape = material.parameters[2].value.front(),
                               .amplitudes = material.parameters[1].value}};
}

Conversion convert(const Material& from, const brdf::Model& to, const ConversionOptions& options) {
  const auto lobe = lobe_material_of(from);
  const bool is_lobe =
      to.name().starts_with(lambert_plus) && to.terms().size() == 2 && lobe.has_value();
  if (is_lobe) {
    const std::string term(to.terms()[1]->description.name);
    const auto terms = convertible_terms();
    if (std::find(terms.begin(), terms.end(), term) != terms.end()) {
      return convert(*lobe, term, options);
    }
  }
  if (options.method == ConversionMethod::closed_form) {
    throw std::invalid_argument(
        fmt::format("there is no closed form from {} to {}: it is for lambert and one isotropic "
                    "lobe on both sides; use --method best-fit",
                    from.model, to.name()));
  }
  const fit::Metric metric = require_usable(options.metric);
  const brdf::BoundModel bound = bind(from);
  const Incidence incidence =
      bound.model().is_anisotropic() ? default_incidence(bound.model()) : default_incidence(to);
  const table::SampleTable samples =
      sample(reflectance_of(bound), from.channels, options.incidence.value_or(incidence));
  Conversion conversion =
      judged(nearest_material(samples, to, metric, shared_diffuse(from, to)), samples, options);
  conversion.material.name = from.name;
  conversion.material.conversion->from = from.model;
  return conversion;
}

}  // namespace gonio::material
