#include "trade/table_check.h"

#include <algorithm>
#include <vector>

#include "fit/options.h"
#include "lut/table_model.h"
#include "shader/evaluate.h"
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
                       const lut::Table& table, lut::Filter filter, shader::VulkanDevice* device) {
  const Reference at_texels = reference_at_texels(model, table.layout, reference.gauge);
  const Reference everywhere = joined(at_texels, reference);
  const auto predicted = [&](lut::Weights weights) {
    return predicted_error(model, everywhere, table, filter, weights);
  };
  TableCheck check{{table.layout, filter},
                   at_texels.pairs.size(),
                   predicted(lut::Weights::exact),
                   predicted(lut::Weights::quantised),
                   std::nullopt,
                   std::nullopt};
  if (device == nullptr) return check;
  const auto& pairs = everywhere.pairs_in_float;
  check.analytic = error_of_floats(everywhere, shader::evaluate(*device, model, pairs));
  check.measured =
      error_of_floats(everywhere, shader::evaluate(*device, model, {table, filter}, pairs));
  return check;
}

TableCheck check_table(const brdf::BoundModel& model, const Reference& reference,
                       const TableChoice& table, shader::VulkanDevice* device) {
  return check_table(model, reference, lut::bake(table.layout), table.filter, device);
}

EvaluatorError predicted_error(const TableCheck& check) {
  return worse_of(check.predicted, check.predicted_quantised);
}

EvaluatorError worst_error(const TableCheck& check) {
  const EvaluatorError predicted = predicted_error(check);
  return check.measured ? worse_of(predicted, *check.measured) : predicted;
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
