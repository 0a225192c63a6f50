#include "fit/ranking.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fit/compression.h"
#include "fit/projection.h"
#include "fit/subset.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {
namespace {

/// Directions that the question is asked of: it is one of coverage, not of precision.
constexpr std::size_t subset_samples = 4096;

/// A shape well inside the search range, with no two parameters alike.
std::vector<double> ordinary_shape(const brdf::Model& model) {
  std::vector<double> shape;
  for (std::size_t j = 0; j < model.shape().size(); ++j) {
    const brdf::Parameter& p = model.shape()[j].descriptor;
    const double share = 0.65 + 0.05 * double(j % 4);
    shape.push_back(p.scale == brdf::Scale::logarithmic
                        ? p.search_lower * std::pow(p.search_upper / p.search_lower, share)
                        : p.search_lower + share * (p.search_upper - p.search_lower));
  }
  return shape;
}

/// The parameters that the directions of `samples` cannot tell apart in an ordinary material.
std::set<std::string> undetermined_parameters(const WeightedSamples& samples,
                                              const BatchModel& batch,
                                              std::span<const std::string> channels) {
  const std::vector<Unknown> unknowns = unknowns_of(batch.model(), channels);
  const ParameterValues values{
      ordinary_shape(batch.model()),
      Eigen::MatrixXd::Ones(Eigen::Index(batch.amplitude_count()), Eigen::Index(channels.size()))};
  const LinearSystem system =
      linear_system_of(compress(samples, batch, values.shape, true, {}), batch, values.amplitudes);
  const Identifiability identifiability(system, batch.model(), box_of(batch.model(), channels, {}),
                                        values, unknowns);
  std::set<std::string> names;
  for (const std::vector<std::size_t>& group : identifiability.undetermined()) {
    for (const std::size_t u : group) names.insert(unknowns[u].parameter);
  }
  return names;
}

}  // namespace

std::vector<std::string> determinable_models(const table::SampleTable& table,
                                             const Options& options,
                                             std::vector<std::string>& excluded) {
  Options plain;
  plain.metric = Metric::l2;
  plain.max_theta_deg = options.max_theta_deg;
  std::vector<std::string> names;
  std::optional<table::SampleTable> subset;
  for (const std::string& name : brdf::model_names()) {
    const brdf::Model model(name);
    const BatchModel batch(model);
    if (!subset) {
      const table::SampleFilter filter(table, plain.max_theta_deg);
      subset = representative_subset(table, filter,
                                     survey_of(table, filter, options.threads).used_samples,
                                     subset_samples, options.threads);
    }
    const WeightedSamples samples(
        *subset, batch, plain,
        survey_of(*subset, table::SampleFilter(*subset, plain.max_theta_deg), 1));
    const std::set<std::string> undetermined =
        undetermined_parameters(samples, batch, table.channels);
    if (undetermined.empty()) {
      names.push_back(name);
    } else {
      excluded.push_back(fmt::format("{}: left out, these directions cannot tell {} apart", name,
                                     fmt::join(undetermined, ", ")));
    }
  }
  return names;
}

bool ranks_before(const FitResult& a, const FitResult& b) {
  if (a.metric_error != b.metric_error) return a.metric_error < b.metric_error;
  return a.unknowns.size() < b.unknowns.size();
}

}  // namespace gonio::fit
