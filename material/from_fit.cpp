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

FitSummary summary_of(const fit::FitResult& result) {
  FitSummary summary;
  summary.metric = name(result.metric);
  summary.loss = "none";
  summary.covariance = name(result.uncertainty.kind);
  summary.samples = result.samples;
  summary.used = result.used;
  summary.converged = result.converged;
  summary.iterations = result.iterations;
  for (const auto& [metric, error] : result.errors) summary.errors.emplace_back(metric, error);
  summary.reduced_chi2 = result.uncertainty.reduced_chi2;
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
