#include "bench/shader_accuracy_study.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "brdf/float_direction.h"
#include "shader/evaluate.h"
#include "trade/lobe_gauge.h"

namespace gonio::bench {
namespace {

bool within_60_degrees(const DirectionPair<float>& pair) {
  return pair.wi.z >= 0.5F && pair.wo.z >= 0.5F;
}

/// What the shaders of a material are compared with.
struct Comparison {
  std::vector<DirectionPair<float>> pairs;
  std::size_t channels;
  std::vector<double> expected;  // f_r, [pair][channel]
  trade::LobeGauge gauge;
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
    const double expected = comparison.expected[k];
    const double difference = std::abs(double(found[k]) - expected);
    keep_worse(errors.worst,
               {difference / comparison.gauge.at(c, expected), c, expected, found[k], pair});
    keep_worse(errors.worst_of_peak,
               {difference / comparison.gauge.peak(c), c, expected, found[k], pair});
  }
}

double input_rounding(const Comparison& comparison, const std::vector<double>& unrounded) {
  double worst = 0;
  for (std::size_t k = 0; k < unrounded.size(); ++k) {
    if (!within_60_degrees(comparison.pairs[k / comparison.channels])) continue;
    const double change = std::abs(comparison.expected[k] - unrounded[k]);
    worst = std::max(worst, change / comparison.gauge.peak(k % comparison.channels));
  }
  return worst;
}

}  // namespace

std::vector<ShaderErrors> shader_errors(const ShaderMaterial& material,
                                        const ShaderAccuracySettings& settings,
                                        shader::VulkanDevice& device) {
  const auto unrounded = shader_directions(material, settings.pairs, settings.seed);
  std::vector<DirectionPair<float>> pairs;
  std::vector<DirectionPair<double>> rounded;
  for (const auto& pair : unrounded) {
    pairs.push_back(brdf::in_float(pair));
    rounded.push_back(brdf::in_double(pairs.back()));
  }
  const brdf::BoundModel& model = material.bound;
  const Comparison comparison{std::move(pairs), model.channel_count(),
                              trade::reflectances(model, rounded),
                              trade::LobeGauge(model, rounded)};
  const double rounding = input_rounding(comparison, trade::reflectances(model, unrounded));

  std::vector<ShaderErrors> both;
  for (const shader::Language language : {shader::Language::hlsl, shader::Language::glsl}) {
    ShaderErrors errors;
    errors.model = material.model;
    errors.parameters = material.parameters;
    errors.language = language;
    errors.input_rounding = rounding;
    errors.input_rounding_bound = input_rounding_bound(material);
    compare(comparison, shader::evaluate(device, model, comparison.pairs, language), errors);
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
