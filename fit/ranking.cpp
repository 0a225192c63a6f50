#include "fit/ranking.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>

#include "fit/compression.h"
#include "fit/nested.h"
#include "fit/projection.h"
#include "fit/scale.h"
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
    shape.push_back(parameter_between(p.scale, p.search_lower, p.search_upper, share));
  }
  return shape;
}

/// Amplitudes of a material of some colour, away from all bounds.
Eigen::MatrixXd ordinary_amplitudes(const brdf::Model& model, std::size_t channels) {
  Eigen::MatrixXd amplitudes(Eigen::Index(model.amplitudes().size()), Eigen::Index(channels));
  for (Eigen::Index k = 0; k < amplitudes.rows(); ++k) {
    for (Eigen::Index c = 0; c < amplitudes.cols(); ++c) {
      amplitudes(k, c) = 0.3 + 0.4 * double(c + 1) / double(channels + 1);
    }
  }
  return amplitudes;
}

/// The parameters that the directions of `samples` cannot tell apart in an ordinary material.
std::set<std::string> undetermined_parameters(const WeightedSamples& samples,
                                              const BatchModel& batch,
                                              std::span<const std::string> channels) {
  const std::vector<Unknown> unknowns = unknowns_of(batch.model(), channels);
  const ParameterValues values{ordinary_shape(batch.model()),
                               ordinary_amplitudes(batch.model(), channels.size())};
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

/// rho_s = 1 - rho_d can be asked of it.
bool can_be_homogeneous(const brdf::Model& model, std::span<const std::string> channels) {
  return model.amplitudes().size() == 2 && has_parameter(model, channels, "rho_d") &&
         has_parameter(model, channels, "rho_s");
}

/// Where the richer relative stands that makes a model no better; none if there is none.
std::optional<std::ptrdiff_t> place_of_needless_relative(std::span<const FitResult> results,
                                                         const std::vector<std::size_t>& order,
                                                         const FitResult& result) {
  if (!result.nested || result.nested->p_value <= nested_significance) return std::nullopt;
  const auto found = std::find_if(order.begin(), order.end(), [&](std::size_t i) {
    return results[i].model.name() == result.nested->in;
  });
  if (found == order.end()) return std::nullopt;
  return found - order.begin();
}

}  // namespace

std::vector<std::string> determinable_models(const table::SampleTable& table,
                                             const Options& options,
                                             std::vector<std::string>& excluded,
                                             brdf::Frame frame) {
  Options plain;
  plain.metric = Metric::l2;
  plain.max_theta_deg = options.max_theta_deg;
  std::vector<std::string> names;
  std::optional<table::SampleTable> subset;
  for (const std::string& name : brdf::model_names()) {
    const brdf::Model model(name, frame);
    if (options.homogeneous && !can_be_homogeneous(model, table.channels)) {
      excluded.push_back(
          fmt::format("{}: left out, it has no rho_s that could be 1 - rho_d", name));
      continue;
    }
    if (table.takes_isotropy && model.is_anisotropic()) {
      excluded.push_back(fmt::format(
          "{}: left out, the file takes the material for isotropic; -m {} fits it all the same",
          name, name));
      continue;
    }
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

std::vector<std::size_t> ranking(std::span<const FitResult> results) {
  std::vector<std::size_t> by_error(results.size());
  std::iota(by_error.begin(), by_error.end(), std::size_t(0));
  std::stable_sort(by_error.begin(), by_error.end(), [&](std::size_t a, std::size_t b) {
    return ranks_before(results[a], results[b]);
  });
  std::vector<std::size_t> order;
  for (const std::size_t i : by_error) {
    const auto relative = place_of_needless_relative(results, order, results[i]);
    order.insert(order.begin() + relative.value_or(std::ptrdiff_t(order.size())), i);
  }
  return order;
}

}  // namespace gonio::fit
