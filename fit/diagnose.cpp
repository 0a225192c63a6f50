#include "fit/diagnose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace gonio::fit {
namespace {

/// The names of a group of unknowns, each parameter once where all its channels are in.
std::vector<std::string> names_of(const std::vector<std::size_t>& group,
                                  const std::vector<Unknown>& unknowns, std::size_t channels) {
  std::vector<std::string> names;
  for (const std::size_t u : group) {
    const Unknown& unknown = unknowns[u];
    const auto in_group =
        std::size_t(std::count_if(group.begin(), group.end(), [&](std::size_t other) {
          return unknowns[other].parameter == unknown.parameter;
        }));
    const bool whole = unknown.is_shape || in_group == channels;
    const std::string& name = whole ? unknown.parameter : unknown.name;
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

/// The shape parameters of a term, by name.
std::vector<std::string> shape_names(const brdf::Model& model, std::size_t term) {
  std::vector<std::string> names;
  for (const brdf::ModelParameter& parameter : model.shape()) {
    if (parameter.term == term) names.push_back(parameter.name);
  }
  return names;
}

/// True if no channel has any of the term.
bool term_is_absent(const FitResult& result, std::size_t term) {
  for (std::size_t k = 0; k < result.model.amplitudes().size(); ++k) {
    if (result.model.amplitudes()[k].term != term) continue;
    if ((result.values.amplitudes.row(Eigen::Index(k)).array() != 0).any()) return false;
  }
  return true;
}

void warn_of_absent_terms(const FitResult& result, std::vector<std::string>& warnings) {
  for (std::size_t term = 0; term < result.model.terms().size(); ++term) {
    const std::vector<std::string> shape = shape_names(result.model, term);
    if (shape.empty() || !term_is_absent(result, term)) continue;
    warnings.push_back(fmt::format(
        "the amplitude of {} is 0 in every channel: {} means nothing here; the material shows no "
        "such lobe, try a model without it",
        result.model.terms()[term]->description.name, fmt::join(shape, ", ")));
  }
}

void warn_of_undetermined(const FitResult& result, const Identifiability& identifiability,
                          std::vector<std::string>& warnings) {
  for (const std::vector<std::size_t>& group : identifiability.undetermined()) {
    const bool of_absent_term =
        group.size() == 1 && result.unknowns[group.front()].is_shape &&
        term_is_absent(result, result.model.shape()[result.unknowns[group.front()].index].term);
    if (group.empty() || of_absent_term) continue;
    const std::vector<std::string> names = names_of(group, result.unknowns, result.channels.size());
    const auto names_one_of = [&](std::string_view wanted) {
      return std::find(names.begin(), names.end(), wanted) != names.end();
    };
    std::string advice = "measure other directions, or fix one with --fix";
    if (names_one_of("alpha_x") || names_one_of("alpha_y")) {
      advice =
          "the half vectors cover no azimuth there, so that alpha_x cannot be told against "
          "alpha_y: "
          "turn the sample and measure again, or fit an isotropic model";
    }
    warnings.push_back(names.size() == 1 ? fmt::format("these directions cannot determine {}: {}",
                                                       names.front(), advice)
                                         : fmt::format("these directions cannot tell {} apart: {}",
                                                       fmt::join(names, ", "), advice));
  }
}

void warn_of_amplitudes_at_zero(const FitResult& result, const Box& box,
                                std::vector<std::string>& warnings) {
  for (const Unknown& unknown : result.unknowns) {
    if (unknown.is_shape || box.is_fixed(unknown) || result.values[unknown] != 0) continue;
    if (term_is_absent(result, result.model.amplitudes()[unknown.index].term) &&
        !shape_names(result.model, result.model.amplitudes()[unknown.index].term).empty()) {
      continue;  // said of the whole term
    }
    warnings.push_back(
        fmt::format("{} ends at its bound 0: the data would have it negative", unknown.name));
  }
}

void warn_of_shapes_at_bounds(const FitResult& result, const Box& box,
                              std::vector<std::string>& warnings) {
  for (const Unknown& unknown : result.unknowns) {
    if (!unknown.is_shape || box.is_fixed(unknown)) continue;
    const double value = result.values[unknown];
    // A logarithmic solver comes close to a bound without standing on it.
    const double near = 1e-6 * std::abs(value);
    const bool at_lower = value - box.lower(unknown) <= near;
    const bool at_upper = box.upper(unknown) - value <= near;
    if (!at_lower && !at_upper) continue;
    if (term_is_absent(result, result.model.shape()[unknown.index].term)) continue;
    warnings.push_back(fmt::format("{} ends at its {} bound {}: the data would have it {}",
                                   unknown.name, at_lower ? "lower" : "upper",
                                   at_lower ? box.lower(unknown) : box.upper(unknown),
                                   at_lower ? "smaller" : "larger"));
  }
}

void warn_of_weak_shapes(const FitResult& result, std::vector<std::string>& warnings) {
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    if (!result.unknowns[u].is_shape || !result.uncertainty.stddev[u]) continue;
    const double value = std::abs(result.values[result.unknowns[u]]);
    const double stddev = *result.uncertainty.stddev[u];
    if (stddev <= 0.5 * value) continue;
    warnings.push_back(
        fmt::format("{} is hardly determined: its standard deviation is {:.0f} % of its value",
                    result.unknowns[u].name, 100 * stddev / std::max(value, 1e-300)));
  }
}

/// rho_d and rho_s are shares of the incident light (Ward 1992): their sum must stay below 1.
void warn_of_albedo(const FitResult& result, std::vector<std::string>& warnings) {
  for (std::size_t c = 0; c < result.channels.size(); ++c) {
    double sum = 0;
    std::vector<std::string> names;
    for (std::size_t k = 0; k < result.model.amplitudes().size(); ++k) {
      const std::string& name = result.model.amplitudes()[k].name;
      if (!name.starts_with("rho_")) continue;
      names.push_back(name);
      sum += result.values.amplitudes(Eigen::Index(k), Eigen::Index(c));
    }
    if (sum <= 1) continue;
    warnings.push_back(
        fmt::format("{} of channel {} is {:.3g}, over 1: more light would leave than arrives; is "
                    "the table's quantity declared right?",
                    fmt::join(names, " + "), result.channels[c], sum));
  }
}

void warn_of_misfit(const FitResult& result, std::vector<std::string>& warnings) {
  if (!result.uncertainty.misfit) return;
  warnings.push_back(fmt::format(
      "reduced chi-square is {:.3g}: the residuals are larger than the given noise explains, the "
      "model does not describe this material to that precision{}",
      *result.uncertainty.reduced_chi2,
      result.uncertainty.kind == Covariance::sandwich ? "; the intervals are sandwich intervals"
                                                      : ""));
}

}  // namespace

std::vector<std::string> diagnose(const FitResult& result, const Box& box,
                                  const Identifiability& identifiability) {
  std::vector<std::string> warnings;
  if (!result.converged) {
    warnings.emplace_back("the solver stopped before it converged: the parameters may still move");
  }
  warn_of_absent_terms(result, warnings);
  warn_of_undetermined(result, identifiability, warnings);
  warn_of_albedo(result, warnings);
  warn_of_amplitudes_at_zero(result, box, warnings);
  warn_of_shapes_at_bounds(result, box, warnings);
  warn_of_weak_shapes(result, warnings);
  warn_of_misfit(result, warnings);
  return warnings;
}

}  // namespace gonio::fit
