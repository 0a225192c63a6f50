#include "material/from_fit.h"

#include <filesystem>

namespace gonio::material {
namespace {

std::vector<ParameterValue> parameters_of(const fit::FitResult& result) {
  std::vector<ParameterValue> parameters;
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    const fit::Unknown& unknown = result.unknowns[u];
    if (parameters.empty() || parameters.back().name != unknown.parameter) {
      parameters.push_back({unknown.parameter, {}, {}, {}});
    }
    ParameterValue& parameter = parameters.back();
    parameter.value.push_back(result.values[unknown]);
    parameter.stddev.push_back(result.uncertainty.stddev[u]);
    parameter.interval95.push_back(result.uncertainty.interval95[u]);
  }
  return parameters;
}

Outliers outliers_of(const fit::FitResult& result) {
  Outliers outliers{
      .threshold = result.outlier_threshold, .count = result.outlier_count, .listed = {}};
  for (const fit::Outlier& outlier : result.outliers) {
    outliers.listed.push_back({outlier.sample, result.channels[outlier.channel], outlier.residual});
  }
  return outliers;
}

HeldOut held_out_of(const fit::HeldOut& found) {
  HeldOut held_out{.errors = {found.errors.begin(), found.errors.end()}, .folds = {}};
  for (const fit::HeldOut::Fold& fold : found.folds) {
    held_out.folds.push_back({{fold.lower_deg, fold.upper_deg}, fold.values, fold.error});
  }
  return held_out;
}

FitSummary summary_of(const fit::FitResult& result) {
  FitSummary summary;
  summary.metric = name(result.metric);
  summary.loss = name(result.loss);
  if (result.loss != fit::Loss::none) {
    summary.loss_scale = result.loss_scale;
    summary.outliers = outliers_of(result);
  }
  summary.covariance = name(result.uncertainty.kind);
  summary.samples = result.samples;
  summary.used = result.used;
  summary.converged = result.converged;
  summary.iterations = result.iterations;
  for (const auto& [metric, error] : result.errors) summary.errors.emplace_back(metric, error);
  if (result.held_out) summary.held_out = held_out_of(*result.held_out);
  summary.reduced_chi2 = result.uncertainty.reduced_chi2;
  summary.aicc = result.aicc;
  summary.bic = result.bic;
  if (result.nested) {
    summary.nested = NestedComparison{.in = result.nested->in,
                                      .test = "wald",
                                      .statistic = result.nested->statistic,
                                      .p_value = result.nested->p_value,
                                      .text = result.nested->text};
  }
  for (const fit::Unknown& unknown : result.unknowns) {
    summary.correlation_parameters.push_back(unknown.name);
  }
  summary.correlation = result.uncertainty.correlation;
  summary.warnings = result.warnings;
  return summary;
}

}  // namespace

Material from_fit(const fit::FitResult& result, const table::SampleTable& table,
                  const std::string& command) {
  Material material;
  material.name = table.name.empty() ? std::filesystem::path(table.provenance.path).stem().string()
                                     : table.name;
  material.model = result.model.name();
  material.channels = result.channels;
  material.parameters = parameters_of(result);
  material.fit = summary_of(result);
  material.provenance = MaterialProvenance{.table = table.provenance.path,
                                           .sha256 = table.provenance.sha256,
                                           .gonio = GONIO_VERSION,
                                           .command = command};
  return material;
}

}  // namespace gonio::material
