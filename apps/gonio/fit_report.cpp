#include "apps/gonio/fit_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

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

}  // namespace

std::string report_table(const table::SampleTable& table, const fit::FitResult& result,
                         double max_theta_deg) {
  return fmt::format("{}: {}, {} samples, {} used (theta up to {} deg), channel{} {}\n",
                     table.provenance.path, table.provenance.format, result.samples, result.used,
                     max_theta_deg, table.channels.size() == 1 ? "" : "s",
                     fmt::join(table.channels, ", "));
}

std::string report_fit(const fit::FitResult& result) {
  std::string text = fmt::format("\n{}, metric {}, {}, {}\n\n", result.model.name(),
                                 name(result.metric), describe(result.uncertainty.kind),
                                 result.converged ? "converged" : "NOT converged");
  text += fmt::format("  {:<14} {:>14} {:>14}   {}\n", "parameter", "estimate", "std deviation",
                      "95 % interval");
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) text += row_of(result, u);
  text += "\n  root mean square error:";
  for (const auto& [metric, error] : result.errors) {
    text += fmt::format("  {} {:.4g}", metric, error);
  }
  text += '\n';
  if (result.uncertainty.reduced_chi2) {
    text += fmt::format("  reduced chi-square: {:.4g}\n", *result.uncertainty.reduced_chi2);
  }
  return text;
}

std::string report_ranking(const std::vector<fit::FitResult>& results) {
  std::string text = fmt::format("\n  {:<32} {:>10} {:>18} {:>10}\n", "model, best first",
                                 "parameters", error_heading(results.front().metric), "to best");
  for (const fit::FitResult& result : results) {
    const double least = results.front().metric_error;
    const std::string ratio =
        least > 0 ? ratio_text(result.metric_error / least) : std::string("-");
    text += fmt::format("  {:<32} {:>10} {:>18.6g} {:>10}{}\n", result.model.name(),
                        result.unknowns.size(), result.metric_error, ratio,
                        result.converged ? "" : "  not converged");
  }
  return text;
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
