#include "bench/shader_accuracy_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "shader/compose.h"
#include "shader/spirv.h"

namespace gonio::bench {
namespace {

/// The values of a model for all pairs, [pair][channel].
struct Values {
  std::vector<double> f_r;
  std::vector<double> lobe;
};

/// Which basis functions are the lobe's: all but the diffuse term's, if there is more than that.
std::vector<bool> lobe_parts(const brdf::Model& model) {
  std::vector<bool> parts;
  for (const std::size_t t : model.basis_terms()) {
    const bool is_diffuse = model.terms()[t]->description.kind == brdf::TermKind::diffuse;
    parts.push_back(!is_diffuse || model.terms().size() == 1);
  }
  return parts;
}

Values evaluate(const brdf::BoundModel& model, const std::vector<DirectionPair<double>>& pairs) {
  const std::size_t channels = model.channel_count();
  const std::vector<bool> in_lobe = lobe_parts(model.model());
  std::array<double, brdf::most_basis_functions> basis{};
  Values values{std::vector<double>(pairs.size() * channels),
                std::vector<double>(pairs.size() * channels)};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    model.f_r(pairs[i].wi, pairs[i].wo, std::span(values.f_r).subspan(i * channels, channels));
    model.model().basis(model.shape(), pairs[i].wi, pairs[i].wo, basis);
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t b = 0; b < in_lobe.size(); ++b) {
        if (in_lobe[b]) values.lobe[i * channels + c] += model.coefficients(c)[b] * basis[b];
      }
    }
  }
  return values;
}

template <class D>
bool within_60_degrees(const DirectionPair<D>& pair) {
  return pair.wi.z >= D(0.5) && pair.wo.z >= D(0.5);
}

/// The largest of the values, as in Values, of each channel at angles up to 60 degrees.
std::vector<double> largest_within_60_degrees(const std::vector<double>& values,
                                              const std::vector<DirectionPair<double>>& pairs) {
  const std::size_t channels = values.size() / pairs.size();
  std::vector<double> largest(channels);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!within_60_degrees(pairs[i])) continue;
    for (std::size_t c = 0; c < channels; ++c) {
      largest[c] = std::max(largest[c], values[i * channels + c]);
    }
  }
  return largest;
}

/// What the shaders of a material are compared with.
struct Comparison {
  std::vector<DirectionPair<float>> pairs;
  std::size_t channels;
  Values expected;
  std::vector<double> lobe_peaks;  // of each channel, at angles up to 60 degrees, as the next
  std::vector<double> f_r_peaks;

  /// What an error is a fraction of (ShaderErrors::worst).
  double gauge(std::size_t k) const {
    const std::size_t c = k % channels;
    const double value = expected.f_r[k];
    return value > f_r_peaks[c] ? std::max(value, lobe_peaks[c]) : lobe_peaks[c];
  }
};

void keep_worse(ShaderError& worst, const ShaderError& candidate) {
  if (candidate.error > worst.error) worst = candidate;
}

void compare(const Comparison& comparison, const std::vector<float>& found, ShaderErrors& errors) {
  for (std::size_t k = 0; k < found.size(); ++k) {
    const DirectionPair<float>& pair = comparison.pairs[k / comparison.channels];
    const std::size_t c = k % comparison.channels;
    if (!std::isfinite(found[k])) {
      ++errors.not_finite;
      continue;
    }
    if (!(pair.wi.z > 0 && pair.wo.z > 0) && found[k] != 0) ++errors.lit_below_horizon;
    const double expected = comparison.expected.f_r[k];
    const double difference = std::abs(double(found[k]) - expected);
    keep_worse(errors.worst, {difference / comparison.gauge(k), c, expected, found[k], pair});
    keep_worse(errors.worst_of_peak,
               {difference / comparison.lobe_peaks[c], c, expected, found[k], pair});
  }
}

double input_rounding(const Comparison& comparison, const Values& unrounded) {
  double worst = 0;
  for (std::size_t k = 0; k < unrounded.f_r.size(); ++k) {
    if (!within_60_degrees(comparison.pairs[k / comparison.channels])) continue;
    const double change = std::abs(comparison.expected.f_r[k] - unrounded.f_r[k]);
    worst = std::max(worst, change / comparison.lobe_peaks[k % comparison.channels]);
  }
  return worst;
}

}  // namespace

std::vector<float> shader_values(const brdf::BoundModel& model, shader::Language language,
                                 const std::vector<DirectionPair<float>>& pairs,
                                 shader::VulkanDevice& device) {
  std::vector<float> input;
  input.reserve(6 * pairs.size());
  for (const auto& [wi, wo] : pairs) {
    input.insert(input.end(), {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z});
  }
  const auto spirv =
      shader::compile(shader::evaluation_kernel(model, language, {"material", {}}), language);
  return device.run(spirv, input, pairs.size() * model.channel_count(),
                    static_cast<std::uint32_t>(pairs.size()));
}

std::vector<ShaderErrors> shader_errors(const ShaderMaterial& material,
                                        const ShaderAccuracySettings& settings,
                                        shader::VulkanDevice& device) {
  const auto unrounded = shader_directions(material, settings.pairs, settings.seed);
  Comparison comparison;
  std::vector<DirectionPair<double>> rounded;
  for (const auto& pair : unrounded) {
    comparison.pairs.push_back(in_float(pair));
    rounded.push_back(in_double(comparison.pairs.back()));
  }
  comparison.channels = material.bound.channel_count();
  comparison.expected = evaluate(material.bound, rounded);
  comparison.lobe_peaks = largest_within_60_degrees(comparison.expected.lobe, rounded);
  comparison.f_r_peaks = largest_within_60_degrees(comparison.expected.f_r, rounded);
  const double rounding = input_rounding(comparison, evaluate(material.bound, unrounded));

  std::vector<ShaderErrors> both;
  for (const shader::Language language : {shader::Language::hlsl, shader::Language::glsl}) {
    ShaderErrors errors;
    errors.model = material.model;
    errors.parameters = material.parameters;
    errors.language = language;
    errors.input_rounding = rounding;
    errors.input_rounding_bound = input_rounding_bound(material);
    compare(comparison, shader_values(material.bound, language, comparison.pairs, device), errors);
    both.push_back(std::move(errors));
  }
  return both;
}

std::vector<ShaderErrors> shader_accuracy(LobeWidths widths, const ShaderAccuracySettings& settings,
                                          shader::VulkanDevice& device) {
  std::vector<ShaderErrors> all;
  for (const brdf::Model& model : shader_models()) {
    for (const ShaderMaterial& material : shader_materials(model, widths)) {
      for (ShaderErrors& errors : shader_errors(material, settings, device)) {
        all.push_back(std::move(errors));
      }
    }
  }
  return all;
}

bool figure_holds(const ShaderErrors& errors) {
  return errors.worst.error <= shader_figure && errors.not_finite == 0 &&
         errors.lit_below_horizon == 0;
}

double input_rounding_bound(const ShaderMaterial& material) {
  constexpr double unit_roundoff = 0x1p-24;
  constexpr double smooth_factors = 8;
  const double steepest = std::sqrt(2 / std::numbers::e);  // the slope of exp(-x^2)
  double per_lobe = 0;
  for (const LobeScale& lobe : material.lobes) {
    const double narrowest = std::min(lobe.x, lobe.y);
    per_lobe = std::max(per_lobe, steepest * std::numbers::sqrt2 / narrowest);
  }
  return unit_roundoff * (per_lobe + smooth_factors);
}

}  // namespace gonio::bench
