#include "bench/coverage_report.h"

#include <fmt/format.h>

#include <iterator>

namespace gonio::bench {
namespace {

double percent(double share) { return 100 * share; }

std::string at(const Place& place) {
  return fmt::format("{} {}", place.material->material, place.parameter->name);
}

}  // namespace

std::vector<FigureCheck> check_figures(const Estimator& estimator, const CoverageTotals& totals) {
  const Figures& figures = estimator.figures;
  std::vector<FigureCheck> checks;
  if (figures.largest_ratio) {
    const double ratio = totals.largest_ratio.parameter->ratio;
    checks.push_back(
        {fmt::format("each RMS error at most {} Cramer-Rao bounds", *figures.largest_ratio),
         fmt::format("{:.4f} ({})", ratio, at(totals.largest_ratio)),
         ratio <= *figures.largest_ratio});
  }
  if (figures.largest_mean_ratio) {
    checks.push_back({fmt::format("their mean at most {}", *figures.largest_mean_ratio),
                      fmt::format("{:.4f}", totals.mean_ratio),
                      totals.mean_ratio <= *figures.largest_mean_ratio});
  }
  const double least = totals.least_coverage.parameter->coverage;
  const double largest = totals.largest_coverage.parameter->coverage;
  checks.push_back(
      {fmt::format("each 95 % interval holds the truth in {:g} to {:g} %",
                   percent(figures.coverage.lower), percent(figures.coverage.upper)),
       fmt::format("{:.2f} % ({}) to {:.2f} % ({})", percent(least), at(totals.least_coverage),
                   percent(largest), at(totals.largest_coverage)),
       figures.coverage.holds(least) && figures.coverage.holds(largest)});
  checks.push_back(
      {fmt::format("all together in {:g} to {:g} %", percent(figures.pooled_coverage.lower),
                   percent(figures.pooled_coverage.upper)),
       fmt::format("{:.2f} % of {} intervals", percent(totals.pooled_coverage), totals.intervals),
       figures.pooled_coverage.holds(totals.pooled_coverage)});
  checks.push_back({"every fit converges",
                    fmt::format("{} of {} did not", totals.not_converged, totals.fits),
                    totals.not_converged == 0});
  return checks;
}

std::string parameter_table(const Estimator& estimator,
                            std::span<const MaterialCoverage> materials) {
  std::string text = fmt::format("{}\n", estimator.name);
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{:<26} {:<10} {:>7} {:>11} {:>9} {:>10} {:>11} {:>9}\n", "material",
                 "parameter", "truth", "bound", "bias/bound", "RMS/bound", "RMS/stddev",
                 "coverage");
  for (const MaterialCoverage& material : materials) {
    std::string_view title = material.material;
    for (const ParameterCoverage& parameter : material.parameters) {
      fmt::format_to(out,
                     "{:<26} {:<10} {:>7g} {:>11.4e} {:>+10.4f} {:>10.4f} {:>11.4f} {:>7.2f} %\n",
                     title, parameter.name, parameter.truth, parameter.bound, parameter.bias,
                     parameter.ratio, parameter.pull, percent(parameter.coverage));
      title = "";
    }
  }
  return text;
}

std::string figure_lines(const Estimator& estimator, std::span<const MaterialCoverage> materials) {
  const CoverageTotals totals = sum_up(materials);
  std::string text = fmt::format("{}: {} fits of {} materials; mean RMS/bound {:.4f}; ",
                                 estimator.name, totals.fits, materials.size(), totals.mean_ratio);
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{} fits switched to another covariance\n", totals.switched);
  if (materials.front().fits < fits_of_the_figures) {
    fmt::format_to(out,
                   "  the figures are meant for {} fits of each material: fewer scatter more\n",
                   fits_of_the_figures);
  }
  for (const FigureCheck& check : check_figures(estimator, totals)) {
    fmt::format_to(out, "  {:<11}  {}: {}\n", check.reached ? "reached" : "NOT REACHED",
                   check.promise, check.found);
  }
  return text;
}

nlohmann::ordered_json to_json(const Estimator& estimator,
                               std::span<const MaterialCoverage> materials) {
  const CoverageTotals totals = sum_up(materials);
  nlohmann::ordered_json json{
      {"estimator", estimator.name},           {"fits", totals.fits},
      {"not_converged", totals.not_converged}, {"switched_covariance", totals.switched},
      {"mean_ratio", totals.mean_ratio},       {"pooled_coverage", totals.pooled_coverage}};
  for (const FigureCheck& check : check_figures(estimator, totals)) {
    json["figures"].push_back(
        {{"promise", check.promise}, {"found", check.found}, {"reached", check.reached}});
  }
  for (const MaterialCoverage& material : materials) {
    nlohmann::ordered_json entry{{"name", material.material},
                                 {"model", material.model},
                                 {"samples", material.samples},
                                 {"fits", material.fits},
                                 {"not_converged", material.not_converged},
                                 {"switched_covariance", material.switched}};
    for (const ParameterCoverage& parameter : material.parameters) {
      entry["parameters"].push_back({{"name", parameter.name},
                                     {"truth", parameter.truth},
                                     {"bound", parameter.bound},
                                     {"bias", parameter.bias},
                                     {"ratio", parameter.ratio},
                                     {"pull", parameter.pull},
                                     {"coverage", parameter.coverage}});
    }
    json["materials"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace gonio::bench
