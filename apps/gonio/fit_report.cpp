#include "apps/gonio/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace gonio::app {
namespace {

/// Numbers of one row, with as many decimals as the standard deviation makes sense of (two digits
/// of it), at least four; in scientific notation where that would take too many.
struct RowFormat {
  int decimals;
  bool scientific;

  std::string operator()(double value) const {
    return scientific ? fmt::format("{:.6g}", value) : fmt::format("{:.{}f}", value, decimals);
  }
};

RowFormat format_for(double value, const std::optional<double>& stddev) {
  const double scale = stddev && *stddev > 0 ? *stddev / 10 : std::abs(value) * 1e-5;
  if (!(scale > 0)) return {4, false};
  const double decimals = std::max(std::ceil(-std::log10(scale)), 4.0);
  return {int(std::min(decimals, 12.0)), decimals > 12 || std::abs(value) >= 1e7};
}

std::string row_of(const fit::FitResult& result, std::size_t u) {
  const fit::Unknown& unknown = result.unknowns[u];
  const double value = result.values[unknown];
  const std::optional<double>& stddev = result.uncertainty.stddev[u];
  const RowFormat text = format_for(value, stddev);
  const std::string row = fmt::format("  {:<14} {:>14}", unknown.name, text(value));
  if (!stddev) {
    return row + fmt::format(" {:>14}   {}\n", "-", unknown.fixed ? "fixed" : "not determined");
  }
  const auto& [low, high] = *result.uncertainty.interval95[u];
  return row + fmt::format(" {:>14}   {} .. {}\n", text(*stddev), text(low), text(high));
}

std::string_view describe(fit::Covariance kind) {
  switch (kind) {
    case fit::Covariance::known_sigma:
      return "intervals from the known sigma";
    case fit::Covariance::residual:
      return "intervals from the residuals' variance";
    case fit::Covariance::sandwich:
      return "sandwich intervals";
    case fit::Covariance::automatic:
      break;
  }
  return "";
}

/// Words in lines of at most 100 characters, each after the indent.
std::string in_lines(std::string_view text, std::string_view indent) {
  constexpr std::size_t most = 100;
  std::string lines;
  std::string line;
  while (!text.empty()) {
    const std::size_t blank = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, blank);
    text.remove_prefix(std::min(blank + 1, text.size()));
    if (!line.empty() && line.size() + 1 + word.size() > most) {
      lines += line + '\n';
      line.clear();
    }
    line += line.empty() ? std::string(indent) : " ";
    line += word;
  }
  return lines + line + '\n';
}

/// Model, metric, loss, the kind of intervals, convergence.
std::string headline(const fit::FitResult& result, const fit::Options& options) {
  const std::string loss =
      result.loss == fit::Loss::none
          ? ""
          : fmt::format(", loss {} at {:.4g} ({})", name(result.loss), result.loss_scale,
                        options.loss_scale ? "given" : "found");
  return in_lines(fmt::format("{}, metric {}{}, {}, {}", result.model.name(), name(result.metric),
                              loss, describe(result.uncertainty.kind),
                              result.converged ? "converged" : "NOT converged"),
                  "");
}

std::string report_outliers(const fit::FitResult& result, const fit::Options& options) {
  constexpr std::size_t most_shown = 3;
  std::string text =
      fmt::format("  outliers: {} of {} values beyond {:.4g} (5 {}standard deviations{})\n",
                  result.outlier_count == 0 ? "none" : fmt::format("{}", result.outlier_count),
                  result.used_values, result.outlier_threshold, options.loss_scale ? "" : "robust ",
                  options.loss_scale ? " by the given scale" : "");
  if (result.outliers.empty()) return text;
  std::vector<std::string> worst;
  for (const fit::Outlier& outlier :
       std::span(result.outliers).first(std::min(result.outliers.size(), most_shown))) {
    worst.push_back(fmt::format("sample {} {} {:.4g}", outlier.sample,
                                result.channels[outlier.channel], outlier.residual));
  }
  return text + fmt::format("  worst: {}\n", fmt::join(worst, ", "));
}

/// What a ranking shows, and what its ratios and differences refer to: the least of all models.
struct RankingColumns {
  std::size_t model_width = std::string_view("model, best first").size();
  double least_error = std::numeric_limits<double>::infinity();
  std::optional<double> held_out;
  /// Of AICc and BIC.
  std::optional<std::pair<double, double>> criteria;
};

RankingColumns ranking_columns(const std::vector<fit::FitResult>& results) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  RankingColumns columns;
  for (const fit::FitResult& result : results) {
    columns.model_width = std::max(columns.model_width, result.model.name().size());
    columns.least_error = std::min(columns.least_error, result.metric_error);
    if (result.held_out) {
      columns.held_out =
          std::min(columns.held_out.value_or(infinity), result.held_out->metric_error);
    }
    if (result.aicc && result.bic) {
      const auto [aicc, bic] = columns.criteria.value_or(std::pair(infinity, infinity));
      columns.criteria = {std::min(aicc, *result.aicc), std::min(bic, *result.bic)};
    }
  }
  return columns;
}

std::string ratio_to(double least, double error) {
  return least > 0 ? ratio_text(error / least) : "-";
}

std::string difference_text(double difference) {
  return difference < 1e5 ? fmt::format("{:.1f}", difference) : fmt::format("{:.1e}", difference);
}

std::string ranking_row(const fit::FitResult& result, const RankingColumns& columns) {
  std::string row = fmt::format("  {:<{}} {:>8} {:>14.6g} {:>9}", result.model.name(),
                                columns.model_width, result.unknowns.size(), result.metric_error,
                                ratio_to(columns.least_error, result.metric_error));
  if (columns.held_out && result.held_out) {
    row += fmt::format(" {:>11.6g} {:>9}", result.held_out->metric_error,
                       ratio_to(*columns.held_out, result.held_out->metric_error));
  } else if (columns.held_out) {
    row += fmt::format(" {:>11} {:>9}", "-", "-");
  }
  if (columns.criteria && result.aicc && result.bic) {
    row += fmt::format(" {:>7} {:>7}", difference_text(*result.aicc - columns.criteria->first),
                       difference_text(*result.bic - columns.criteria->second));
  } else if (columns.criteria) {
    row += fmt::format(" {:>7} {:>7}", "-", "-");
  }
  return row + (result.converged ? "\n" : "  not converged\n");
}

/// The verdict on each model that is a special case of another.
std::string nested_verdicts(const std::vector<fit::FitResult>& results) {
  std::string text;
  for (const fit::FitResult& result : results) {
    if (result.nested) text += in_lines(result.nested->text, "  ");
  }
  return text.empty() ? text : '\n' + text;
}

}  // namespace

std::string report_table(const table::SampleTable& table, const fit::FitResult& result,
                         double max_theta_deg) {
  return fmt::format("{}: {}, {} samples, {} used (theta up to {} deg), channel{} {}\n",
                     table.provenance.path, table.provenance.format, result.samples, result.used,
                     max_theta_deg, table.channels.size() == 1 ? "" : "s",
                     fmt::join(table.channels, ", "));
}

std::string report_fit(const fit::FitResult& result, const fit::Options& options) {
  std::string text = '\n' + headline(result, options) + '\n';
  text += fmt::format("  {:<14} {:>14} {:>14}   {}\n", "parameter", "estimate", "std deviation",
                      "95 % interval");
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) text += row_of(result, u);
  text += "\n  rms errors:";
  for (const auto& [metric, error] : result.errors) {
    text += fmt::format("  {} {:.4g}", metric, error);
  }
  text += '\n';
  if (result.uncertainty.reduced_chi2) {
    text += fmt::format("  reduced chi-square: {:.4g}\n", *result.uncertainty.reduced_chi2);
  }
  if (result.loss != fit::Loss::none) text += report_outliers(result, options);
  return text;
}

std::string report_ranking(const std::vector<fit::FitResult>& results) {
  const RankingColumns columns = ranking_columns(results);
  std::string text =
      fmt::format("\n  {:<{}} {:>8} {:>14} {:>9}", "model, best first", columns.model_width,
                  "unknowns", error_heading(results.front().metric), "to best");
  if (columns.held_out) text += fmt::format(" {:>11} {:>9}", "held out", "to best");
  if (columns.criteria) text += fmt::format(" {:>7} {:>7}", "AICc", "BIC");
  text += '\n';
  for (const fit::FitResult& result : results) text += ranking_row(result, columns);
  return text + nested_verdicts(results);
}

// Three decimals, but not for a noise-free best that makes all others astronomically worse.
std::string ratio_text(double ratio) {
  return ratio < 1e5 ? fmt::format("{:.3f} x", ratio) : fmt::format("{:.1e} x", ratio);
}

std::string error_heading(fit::Metric metric) {
  switch (metric) {
    case fit::Metric::l2:
    case fit::Metric::cosine_l2:
      return "error in 1/sr";
    case fit::Metric::chi2:
      return "error in sigma";
    case fit::Metric::log:
    case fit::Metric::cube_root:
    case fit::Metric::relative:
      break;
  }
  return "error";
}

}  // namespace gonio::app
