#include "fit/diagnose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "fit/albedo_warning.h"
#include "fit/scale.h"

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

/// A term as users tell it from the others: with the names of its amplitudes where there are two of
/// its kind.
std::string term_name(const brdf::Model& model, std::size_t term) {
  const auto terms = model.terms();
  std::string name(terms[term]->description.name);
  if (std::count(terms.begin(), terms.end(), terms[term]) < 2) return name;
  for (const brdf::ModelParameter& parameter : model.amplitudes()) {
    if (parameter.term == term) return fmt::format("{} ({})", name, parameter.name);
  }
  return name;
}

/// The term that an unknown belongs to.
std::size_t term_of(const FitResult& result, const Unknown& unknown) {
  return unknown.is_shape ? result.model.shape()[unknown.index].term
                          : result.model.amplitudes()[unknown.index].term;
}

/// True for a shape parameter of a term that the material does not show: said of the whole term.
bool is_shape_of_absent_term(const FitResult& result, const Identifiability& identifiability,
                             const Unknown& unknown) {
  return unknown.is_shape && identifiability.is_absent(term_of(result, unknown));
}

void warn_of_absent_terms(const FitResult& result, const Identifiability& identifiability,
                          std::vector<std::string>& warnings) {
  for (std::size_t term = 0; term < result.model.terms().size(); ++term) {
    const std::vector<std::string> shape = shape_names(result.model, term);
    if (shape.empty() || !identifiability.is_absent(term)) continue;
    warnings.push_back(
        fmt::format("the amplitude of {} is 0 in every channel: {} means nothing here; the "
                    "material shows no such lobe, try a model without it",
                    term_name(result.model, term), fmt::join(shape, ", ")));
  }
}

/// A lobe whose amplitude is not distinguishable from 0 in any channel.
void warn_of_insignificant_terms(const FitResult& result, const Identifiability& identifiability,
                                 std::vector<std::string>& warnings) {
  for (std::size_t term = 0; term < result.model.terms().size(); ++term) {
    const std::vector<std::string> shape = shape_names(result.model, term);
    if (shape.empty() || identifiability.is_absent(term)) continue;
    if (brdf::has_fixed_part(*result.model.terms()[term])) continue;
    bool any_interval = false;
    bool any_significant = false;
    for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
      const Unknown& unknown = result.unknowns[u];
      if (unknown.is_shape || term_of(result, unknown) != term) continue;
      const auto& interval = result.uncertainty.interval95[u];
      any_interval = any_interval || interval.has_value();
      // A fixed amplitude is meant.
      any_significant = any_significant || unknown.fixed || (interval && interval->first > 0);
    }
    if (!any_interval || any_significant) continue;
    warnings.push_back(fmt::format(
        "the amplitude of {} cannot be told from 0 in any channel: do not believe {}; the material "
        "may show no such lobe, try a model without it",
        term_name(result.model, term), fmt::join(shape, ", ")));
  }
}

/// Lobes that no more samples see than could be fitted by anything.
constexpr double fewest_samples = 3;

/// True for a lobe that is narrower than the samples are apart.
bool is_between_samples(const FitResult& result, std::size_t term) {
  const auto basis_terms = result.model.basis_terms();
  for (std::size_t b = 0; b < basis_terms.size(); ++b) {
    if (basis_terms[b] == term && result.seen_by[Eigen::Index(b)] >= fewest_samples) return false;
  }
  return !shape_names(result.model, term).empty();
}

void warn_of_lobes_between_samples(const FitResult& result, const Identifiability& identifiability,
                                   std::vector<std::string>& warnings) {
  for (std::size_t term = 0; term < result.model.terms().size(); ++term) {
    if (identifiability.is_absent(term) || !is_between_samples(result, term)) continue;
    warnings.push_back(fmt::format(
        "hardly more than one sample sees the lobe of {}: it stands for that reading and not for "
        "the material; try a model without it, a robust --loss, or --bounds on {}",
        term_name(result.model, term), fmt::join(shape_names(result.model, term), ", ")));
  }
}

void warn_of_undetermined(const FitResult& result, const Identifiability& identifiability,
                          std::vector<std::string>& warnings) {
  std::vector<std::string> combinations;
  bool roughness = false;
  for (const std::vector<std::size_t>& group : identifiability.undetermined()) {
    if (std::all_of(group.begin(), group.end(), [&](std::size_t u) {
          return is_shape_of_absent_term(result, identifiability, result.unknowns[u]) ||
                 is_between_samples(result, term_of(result, result.unknowns[u]));
        })) {
      continue;
    }
    const std::vector<std::string> names = names_of(group, result.unknowns, result.channels.size());
    for (const std::string& name : names) {
      roughness = roughness || name.starts_with("alpha_x") || name.starts_with("alpha_y");
    }
    const std::string combination = names.size() == 1
                                        ? fmt::format("determine {}", names.front())
                                        : fmt::format("tell {} apart", fmt::join(names, ", "));
    if (std::find(combinations.begin(), combinations.end(), combination) == combinations.end()) {
      combinations.push_back(combination);
    }
  }
  if (combinations.empty()) return;
  warnings.push_back(fmt::format(
      "these directions cannot {}: {}", fmt::join(combinations, ", nor "),
      roughness
          ? "where the half vectors cover no azimuth, alpha_x cannot be told against alpha_y; "
            "turn the sample and measure again, or fit an isotropic model"
          : "measure other directions, or fix one with --fix"));
}

/// Of the larger value or of the range, what two values of a parameter differ by at least.
constexpr double other_share = 1e-4;

/// Two materials that look the same from these directions, each with intervals of its own.
void warn_of_rivals(const FitResult& result, const Box& box, std::vector<std::string>& warnings) {
  for (const ParameterValues& rival : result.rivals) {
    bool is_outside = false;
    std::vector<std::size_t> others;
    std::vector<std::string> values;
    for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
      const Unknown& unknown = result.unknowns[u];
      if (!result.uncertainty.stddev[u]) continue;
      const double here = result.values[unknown];
      const double there = rival[unknown];
      const double range = box.upper(unknown) - box.lower(unknown);
      const double size = std::isfinite(range) ? range : std::max(std::abs(here), std::abs(there));
      const double difference = std::abs(here - there);
      if (difference <= std::max(*result.uncertainty.stddev[u], other_share * size)) continue;
      others.push_back(u);
      values.push_back(fmt::format("{} {:.4g}", unknown.name, there));
      const auto& [lower, upper] = *result.uncertainty.interval95[u];
      is_outside = is_outside || there < lower || there > upper;
    }
    // Where the intervals hold the rival too, they say enough.
    if (!is_outside) continue;
    warnings.push_back(fmt::format(
        "these data cannot tell {} apart: {} explain them as well as the values given, whose "
        "intervals do not know of it; measure other channels or directions, or fix one with --fix",
        fmt::join(names_of(others, result.unknowns, result.channels.size()), ", "),
        fmt::join(values, ", ")));
  }
}

void warn_of_bounds(const FitResult& result, const Box& box, const Identifiability& identifiability,
                    std::vector<std::string>& warnings) {
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    const Unknown& unknown = result.unknowns[u];
    if (unknown.fixed || unknown.dependent || identifiability.is_undetermined(u)) continue;
    if (identifiability.is_absent(term_of(result, unknown))) continue;  // said of the whole term
    if (goes_round(result.model, box, unknown)) continue;
    const double value = result.values[unknown];
    // A logarithmic solver comes close to a bound without standing on it.
    const double near = unknown.is_shape ? 1e-6 * std::max(std::abs(value), least_root) : 0;
    const bool at_lower = value - box.lower(unknown) <= near;
    const bool at_upper = box.upper(unknown) - value <= near;
    if (!at_lower && !at_upper) continue;
    warnings.push_back(fmt::format("{} ends at its {} bound {}: the data would have it {}",
                                   unknown.name, at_lower ? "lower" : "upper",
                                   at_lower ? box.lower(unknown) : box.upper(unknown),
                                   at_lower ? "smaller" : "larger"));
  }
}

void warn_of_empty_channels(const FitResult& result, const Identifiability& identifiability,
                            const Survey& survey, std::vector<std::string>& warnings) {
  for (std::size_t c = 0; c < result.channels.size(); ++c) {
    bool seen = false;
    for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
      const Unknown& unknown = result.unknowns[u];
      if (unknown.is_shape || unknown.channel != c) continue;
      seen = seen || unknown.fixed || !identifiability.is_undetermined(u);
    }
    if (!seen && survey.channel_values[c] < result.model.amplitudes().size() + 1) {
      warnings.push_back(fmt::format("channel {} has too few values to determine anything of it",
                                     result.channels[c]));
    }
  }
}

void warn_of_no_freedom(const FitResult& result, const Identifiability& identifiability,
                        std::vector<std::string>& warnings) {
  if (result.used_values > identifiability.rank()) return;
  warnings.push_back(
      fmt::format("{} values determine {} unknowns and nothing is left to tell how well: measure "
                  "more samples",
                  result.used_values, identifiability.rank()));
}

/// Estimates that go together like this cannot be told apart.
constexpr double inseparable = 0.95;

/// "; the data can hardly tell it from c": what a weak shape goes together with.
std::string companions_of(const FitResult& result, std::size_t weak) {
  std::vector<std::size_t> companions;
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    const auto& correlation = result.uncertainty.correlation[weak][u];
    if (u != weak && correlation && std::abs(*correlation) > inseparable) companions.push_back(u);
  }
  if (companions.empty()) return "";
  return fmt::format(
      "; the data can hardly tell it from {}",
      fmt::join(names_of(companions, result.unknowns, result.channels.size()), ", "));
}

void warn_of_weak_shapes(const FitResult& result, std::vector<std::string>& warnings) {
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    const Unknown& unknown = result.unknowns[u];
    if (!unknown.is_shape || !result.uncertainty.stddev[u]) continue;
    const brdf::Parameter& descriptor = result.model.shape()[unknown.index].descriptor;
    const double stddev = *result.uncertainty.stddev[u];
    if (is_logarithmic(descriptor.scale)) {
      const double value = parameter_slope(descriptor.scale, result.values[unknown]);
      if (stddev <= 0.5 * value) continue;
      warnings.push_back(fmt::format(
          "{} is hardly determined: its standard deviation is {:.0f} % of its value{}",
          unknown.name, 100 * stddev / std::max(value, 1e-300), companions_of(result, u)));
    } else if (stddev > 0.1 * (descriptor.upper - descriptor.lower)) {
      warnings.push_back(fmt::format(
          "{} is hardly determined: its standard deviation is {:.2g}{}, of a range of {:.3g}{}{}",
          unknown.name, stddev, descriptor.unit == "1" ? "" : " " + std::string(descriptor.unit),
          descriptor.upper - descriptor.lower, companions_of(result, u),
          descriptor.scale == brdf::Scale::periodic
              ? "; where alpha_x and alpha_y are alike the "
                "tangent means nothing: try an isotropic model"
              : ""));
    }
  }
}

/// Many values beyond what the bulk scatters by: not outliers, but noise that differs.
void warn_of_many_outliers(const FitResult& result, std::vector<std::string>& warnings) {
  const double share =
      double(result.outlier_count) / double(std::max<std::size_t>(result.used_values, 1));
  if (share <= 0.1) return;
  if (share > 0.5) {
    warnings.push_back(fmt::format(
        "the loss' scale {:.3g} is smaller than most residuals: nearly everything counts as an "
        "outlier, and the fit may have ended anywhere; give a larger --loss-scale or none",
        result.loss_scale));
    return;
  }
  warnings.push_back(fmt::format(
      "{:.0f} % of the values lie beyond 5 standard deviations of the bulk: their noise differs "
      "rather than that they are outliers; with metric relative, or chi2 and --noise, only real "
      "outliers stand out",
      100 * share));
}

/// rho_d and rho_s are shares of the incident light (Ward 1992): their sum must stay below 1.
void warn_of_albedo(const FitResult& result, const Identifiability& identifiability,
                    std::vector<std::string>& warnings) {
  for (std::size_t c = 0; c < result.channels.size(); ++c) {
    double sum = 0;
    bool determined = true;
    std::vector<std::string> names;
    for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
      const Unknown& unknown = result.unknowns[u];
      if (unknown.is_shape || unknown.channel != c || !unknown.name.starts_with("rho_")) continue;
      names.push_back(unknown.parameter);
      sum += result.values[unknown];
      determined = determined && !identifiability.is_undetermined(u);
    }
    // rho_d + (1 - rho_d) may miss 1 by a rounding.
    if (sum <= 1 + 1e-12 || !determined) continue;
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
                                  const Identifiability& identifiability, const Survey& survey) {
  std::vector<std::string> warnings;
  if (!result.converged) {
    warnings.emplace_back("the solver stopped before it converged: the parameters may still move");
  }
  warn_of_empty_channels(result, identifiability, survey, warnings);
  warn_of_no_freedom(result, identifiability, warnings);
  warn_of_absent_terms(result, identifiability, warnings);
  warn_of_insignificant_terms(result, identifiability, warnings);
  warn_of_lobes_between_samples(result, identifiability, warnings);
  warn_of_undetermined(result, identifiability, warnings);
  warn_of_rivals(result, box, warnings);
  warn_of_albedo(result, identifiability, warnings);
  if (const auto warning = albedo_warning(result, identifiability, survey.most_grazing_wi)) {
    warnings.push_back(*warning);
  }
  warn_of_bounds(result, box, identifiability, warnings);
  warn_of_weak_shapes(result, warnings);
  warn_of_misfit(result, warnings);
  warn_of_many_outliers(result, warnings);
  return warnings;
}

}  // namespace gonio::fit
