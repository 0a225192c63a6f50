#include "trade/table_check.h"

#include <algorithm>
#include <vector>

#include "fit/options.h"
#include "lut/table_model.h"
#include "shader/evaluate.h"
#include "trade/float_direction.h"
#include "trade/parameter_uncertainty.h"

namespace gonio::trade {
namespace {

EvaluatorError error_of_floats(const Reference& reference, const std::vector<float>& f_r) {
  return error_of(reference, std::vector<double>(f_r.begin(), f_r.end()));
}

/// The material file's error under the metric that the reference's root mean squares are of.
std::optional<double> residual_on_file(const material::Material& material) {
  if (!material.fit) return std::nullopt;
  for (const auto& [metric, error] : material.fit->errors) {
    if (metric == fit::name(fit::Metric::cosine_l2)) return error;
  }
  return std::nullopt;
}

}  // namespace

std::size_t size_of(const lut::Layout& layout) {
  return std::size_t(layout.width) * std::size_t(layout.height) *
         std::size_t(lut::channels_of(layout.kind)) * lut::bytes_per_channel(layout.storage);
}

EvaluatorError predicted_error(const brdf::BoundModel& model, const Reference& reference,
                               const lut::Table& table, lut::Filter filter, lut::Weights weights) {
  const lut::TableModel by_table(model, table, filter, weights);
  const std::size_t channels = reference.channels;
  std::vector<double> f_r(reference.f_r.size());
  for (std::size_t i = 0; i < reference.pairs.size(); ++i) {
    const auto& [wi, wo] = reference.pairs[i];
    by_table.f_r(wi, wo, std::span(f_r).subspan(i * channels, channels));
  }
  return error_of(reference, f_r);
}

TableCheck check_table(const brdf::BoundModel& model, const Reference& reference,
                       const TableChoice& table, shader::VulkanDevice* device) {
  const lut::Table baked = lut::bake(table.layout);
  const auto predicted = [&](lut::Weights weights) {
    return predicted_error(model, reference, baked, table.filter, weights);
  };
  TableCheck check{table, predicted(lut::Weights::exact), predicted(lut::Weights::quantised),
                   std::nullopt, std::nullopt};
  if (device == nullptr) return check;
  std::vector<brdf::DirectionPair<float>> pairs;
  pairs.reserve(reference.pairs.size());
  for (const auto& pair : reference.pairs) pairs.push_back(in_float(pair));
  check.analytic = error_of_floats(reference, shader::evaluate(*device, model, pairs));
  check.measured =
      error_of_floats(reference, shader::evaluate(*device, model, {baked, table.filter}, pairs));
  return check;
}

double largest_error(const TableCheck& check) {
  const double predicted = check.predicted_quantised.largest;
  return check.measured ? std::max(predicted, check.measured->largest) : predicted;
}

double rms_error(const TableCheck& check) {
  const double predicted = check.predicted_quantised.rms;
  return check.measured ? std::max(predicted, check.measured->rms) : predicted;
}

FitErrors fit_errors(const brdf::BoundModel& model, const material::Material& material,
                     const Reference& reference, const table::SampleTable* samples,
                     double max_theta_deg) {
  FitErrors errors;
  errors.residual = samples != nullptr ? cosine_residual(model, material, *samples, max_theta_deg)
                                       : residual_on_file(material);
  if (const auto stddev = parameter_uncertainty(material, reference.pairs)) {
    errors.uncertainty = radiance_rms(reference, *stddev);
  }
  return errors;
}

}  // namespace gonio::trade
