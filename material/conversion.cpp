#include "material/conversion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "material/evaluate.h"
#include "material/nearest_model.h"
#include "table/file_error.h"

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

/// The lights for both models.
Incidence incidence_for(const brdf::Model& from, const brdf::Model& to,
                        const ConversionOptions& options) {
  Incidence incidence = default_incidence(from.is_anisotropic() ? from : to);
  incidence.theta_deg = options.theta_deg;
  return incidence;
}

/// A fit's own complaint as one about the conversion.
NearestMaterial fitted(const table::SampleTable& samples, const brdf::Model& model,
                       fit::Metric metric, std::span<const fit::ParameterSetting> fixed,
                       std::span<const fit::ParameterSetting> start = {}) {
  try {
    return nearest_material(samples, model, metric, fixed, start);
  } catch (const table::FileError& error) {
    throw std::invalid_argument(fmt::format("nothing can be fitted to it{}", error.what()));
  }
}

/// The material as it is, with its error.
NearestMaterial with_error(Material material, const table::SampleTable& samples,
                           fit::Metric metric) {
  const double error =
      fitted(samples, model_of(material), metric, all_settings(material)).metric_error;
  return {std::move(material), error};
}

Conversion recorded(NearestMaterial nearest, const Difference& remaining, std::string from,
                    const ConversionOptions& options) {
  if (!std::isfinite(remaining.rms)) {
    throw std::invalid_argument(
        "it reflects no light, and the model cannot be black: leave it out");
  }
  Conversion conversion{.material = std::move(nearest.material), .remaining = remaining};
  conversion.material.conversion = ConversionRecord{.from = std::move(from),
                                                    .method = std::string(name(options.method)),
                                                    .metric = std::string(name(options.metric)),
                                                    .metric_error = nearest.metric_error,
                                                    .theta_i_deg = options.theta_deg,
                                                    .peak = remaining.peak,
                                                    .rms = remaining.rms,
                                                    .albedo = remaining.albedo};
  return conversion;
}

/// The closed form, if there is one.
std::optional<Material> closed_material(const LobeMaterial& from, std::string_view to) {
  try {
    return material_of(closed_form(from.lobe, to), from.rho_d, from.channels);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// The shape of a closed form, whatever its amplitude would be, as a place to start from.
std::vector<fit::ParameterSetting> start_at(const LobeMaterial& from, std::string_view to) {
  const auto material = closed_material({{}, {}, {}, {from.lobe.term, from.lobe.shape, {}}}, to);
  if (!material) return {};
  const ParameterValue& shape = material->parameters.back();
  return {{shape.name, shape.value.front()}};
}

bool is_dark(const LobeMaterial& from) {
  return std::all_of(from.lobe.amplitudes.begin(), from.lobe.amplitudes.end(),
                     [](double amplitude) { return amplitude == 0; });
}

/// What a fit is not to move: the diffuse part, and channels in which there is no lobe, as far as
/// the term can be black.
std::vector<fit::ParameterSetting> fixed_by(const LobeMaterial& from, const brdf::Model& target) {
  const Material original = material_of(from.lobe, from.rho_d, from.channels);
  std::vector<fit::ParameterSetting> fixed = shared_diffuse(original, target);
  if (brdf::has_fixed_part(*target.terms()[1])) return fixed;
  for (std::size_t c = 0; c < from.channels.size(); ++c) {
    if (from.lobe.amplitudes[c] == 0) {
      fixed.push_back({target.amplitudes()[1].name + "." + from.channels[c], 0});
    }
  }
  return fixed;
}

/// The best fit, or the closed form where that is better: a search may end in a local minimum.
NearestMaterial best_of(const LobeMaterial& from, std::string_view to,
                        const table::SampleTable& samples, fit::Metric metric) {
  const brdf::Model target(std::string(lambert_plus) + std::string(to));
  const auto closed = closed_material(from, to);
  if (closed && is_dark(from)) return with_error(*closed, samples, metric);
  NearestMaterial best =
      fitted(samples, target, metric, fixed_by(from, target), start_at(from, to));
  if (!closed) return best;
  NearestMaterial other = with_error(*closed, samples, metric);
  return other.metric_error < best.metric_error ? other : best;
}

/// A lobe whose reflected radiance is that of the other one, times the cosine of the incidence once
/// more: fitted in l2, it is a classic highlight fitted in cosine-l2.
NearestMaterial best_classic_of(LobeMaterial from, std::string_view to,
                                table::SampleTable samples) {
  const std::vector<double> rho_d = from.rho_d;
  from.rho_d.assign(rho_d.size(), 0);
  for (std::size_t c = 0; c < samples.values.size(); ++c) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const bool is_lit = samples.wo.z[i] > 0;
      const double diffuse = is_lit ? rho_d[c] / std::numbers::pi : 0;
      samples.values[c][i] = (samples.values[c][i] - diffuse) * samples.wi.z[i];
    }
  }
  NearestMaterial best = best_of(from, to, samples, fit::Metric::l2);
  best.material.parameters.front().value = rho_d;
  return best;
}

std::string in_words(const LobeMaterial& from) {
  const Material material = material_of(from.lobe, from.rho_d, from.channels);
  const ParameterValue& shape = material.parameters.back();
  return fmt::format("{}, {} {:.6g}{}", from.lobe.term, shape.name, shape.value.front(),
                     from.is_classic ? ", without the cosine of the incidence" : "");
}

void require_classic_target(std::string_view to, const ConversionOptions& options) {
  if (to.ends_with("phong") && options.metric == fit::Metric::cosine_l2 &&
      options.method == ConversionMethod::best_fit) {
    return;
  }
  throw std::invalid_argument(
      "a classic highlight is fitted as phong or blinn-phong, by the best fit in cosine-l2 only");
}

bool is_convertible(std::string_view term) {
  const auto terms = convertible_terms();
  return std::find(terms.begin(), terms.end(), term) != terms.end();
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
  if (options.to_classic) require_classic_target(to, options);
  const brdf::BoundModel bound = bind(material_of(from.lobe, from.rho_d, from.channels));
  const brdf::Model target(std::string(lambert_plus) + std::string(to));
  const table::SampleTable samples =
      sample(from.is_classic ? classic_reflectance(from) : reflectance_of(bound), from.channels,
             incidence_for(bound.model(), target, options));
  NearestMaterial nearest = [&] {
    if (options.to_classic) return best_classic_of(from, to, samples);
    if (options.method == ConversionMethod::best_fit) return best_of(from, to, samples, metric);
    return with_error(material_of(closed_form(from.lobe, to), from.rho_d, from.channels), samples,
                      metric);
  }();
  nearest.material.name = from.name;
  const brdf::BoundModel stand_in = bind(nearest.material);
  const Difference remaining = difference(
      samples, options.to_classic ? classic_reflectance(*lobe_material_of(nearest.material))
                                  : reflectance_of(stand_in));
  return recorded(std::move(nearest), remaining, in_words(from), options);
}

std::optional<LobeMaterial> lobe_material_of(const Material& material) {
  if (!material.model.starts_with(lambert_plus)) return std::nullopt;
  const std::string term = material.model.substr(lambert_plus.size());
  if (!is_convertible(term)) return std::nullopt;
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
  if (lobe && to.name().starts_with(lambert_plus) && to.terms().size() == 2 &&
      is_convertible(to.terms()[1]->description.name)) {
    return convert(*lobe, to.terms()[1]->description.name, options);
  }
  if (options.method == ConversionMethod::closed_form || options.to_classic) {
    throw std::invalid_argument(fmt::format(
        "from {} to {} there is neither a closed form nor a classic highlight: they are "
        "for lambert and one isotropic lobe on both sides",
        from.model, to.name()));
  }
  const fit::Metric metric = require_usable(options.metric);
  const brdf::BoundModel bound = bind(from);
  const table::SampleTable samples =
      sample(reflectance_of(bound), from.channels, incidence_for(bound.model(), to, options));
  NearestMaterial nearest = fitted(samples, to, metric, shared_diffuse(from, to));
  nearest.material.name = from.name;
  const brdf::BoundModel stand_in = bind(nearest.material);
  const Difference remaining = difference(samples, reflectance_of(stand_in));
  return recorded(std::move(nearest), remaining, from.model, options);
}

}  // namespace gonio::material
