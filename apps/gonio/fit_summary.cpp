#include "apps/gonio/fit_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

#include "apps/gonio/fit_report.h"

namespace gonio::app {
namespace {

ModelSummary summary_of(const ModelFit& fit) {
  const fit::FitResult& result = fit.result;
  ModelSummary summary{.model = fit.material.model,
                       .metric = result.metric,
                       .loss = fit.material.fit->loss,
                       .used = result.used,
                       .converged = result.converged,
                       .metric_error = result.metric_error,
                       .held_out_error = {},
                       .errors = fit.material.fit->errors,
                       .warnings = result.warnings.size(),
                       .parameters = {}};
  if (result.held_out) summary.held_out_error = result.held_out->metric_error;
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    const fit::Unknown& unknown = result.unknowns[u];
    summary.parameters.push_back(
        {unknown.name, result.values[unknown], result.uncertainty.stddev[u]});
  }
  return summary;
}

/// The file names without extension, or the paths as given if two names are the same.
std::vector<std::string> row_names(std::span<const TableSummary> tables) {
  std::vector<std::string> paths, names;
  for (const TableSummary& table : tables) {
    paths.push_back(table.table);
    names.push_back(std::filesystem::path(table.table).stem().string());
  }
  const std::set<std::string_view> different(names.begin(), names.end());
  return different.size() == names.size() ? names : paths;
}

/// The error message with "line 7" instead of "path:7", cut to a row's length.
std::string short_reason(const TableSummary& table) {
  constexpr std::size_t most = 70;
  std::string reason = table.error.substr(table.table.size());
  if (reason.starts_with(": ")) {
    reason.erase(0, 2);
  } else if (reason.starts_with(":")) {
    reason.replace(0, 1, "line ");
  }
  const std::size_t blank = reason.rfind(' ', most);
  if (reason.size() <= most || blank == std::string::npos) return reason;
  return reason.substr(0, blank) + " ...";
}

std::string convergence_note(const TableSummary& table) {
  const auto missed = std::count_if(table.fits.begin(), table.fits.end(),
                                    [](const ModelSummary& fit) { return !fit.converged; });
  if (missed == 0) return "";
  if (!table.fits.front().converged) return "  not converged";
  return fmt::format("  {} of {} models not converged", missed, table.fits.size());
}

struct ColumnWidths {
  std::size_t table = std::string_view("table").size();
  std::size_t model = std::string_view("best model").size();
};

ColumnWidths widths_of(std::span<const TableSummary> tables,
                       const std::vector<std::string>& names) {
  ColumnWidths widths;
  for (const std::string& name : names) widths.table = std::max(widths.table, name.size());
  for (const TableSummary& table : tables) {
    if (table.error.empty()) {
      widths.model = std::max(widths.model, table.fits.front().model.size());
    }
  }
  return widths;
}

std::string row_of(const std::string& name, const TableSummary& table, const ColumnWidths& widths) {
  if (!table.error.empty()) {
    return fmt::format("{:<{}}  failed: {}\n", name, widths.table, short_reason(table));
  }
  const ModelSummary& best = table.fits.front();
  const std::string ratio = table.fits.size() > 1 && best.metric_error > 0
                                ? ratio_text(table.fits[1].metric_error / best.metric_error)
                                : std::string("-");
  return fmt::format("{:<{}}  {:>8}  {:<{}}  {:>13.6g}  {:>11}  {:>8}{}\n", name, widths.table,
                     best.used, best.model, widths.model, best.metric_error, ratio, best.warnings,
                     convergence_note(table));
}

/// What all the fits have in common, and the heads of the columns.
std::string heading(std::span<const TableSummary> tables, const ColumnWidths& widths,
                    const fit::Options& options) {
  const auto fitted = std::find_if(tables.begin(), tables.end(),
                                   [](const TableSummary& t) { return t.error.empty(); });
  if (fitted == tables.end()) return "";
  const std::string& loss = fitted->fits.front().loss;
  return fmt::format("metric {}{}, theta up to {} deg\n\n", name(options.metric),
                     loss == "none" ? "" : ", loss " + loss, options.max_theta_deg) +
         fmt::format("{:<{}}  {:>8}  {:<{}}  {:>13}  {:>11}  {:>8}\n", "table", widths.table,
                     "samples", "best model", widths.model, error_heading(options.metric),
                     "second best", "warnings");
}

}  // namespace

bool TableSummary::is_good() const {
  return error.empty() && std::all_of(fits.begin(), fits.end(),
                                      [](const ModelSummary& fit) { return fit.converged; });
}

TableSummary summary_of(const TableFit& table_fit) {
  TableSummary summary{.table = table_fit.table.provenance.path};
  for (const ModelFit& fit : table_fit.fits) summary.fits.push_back(summary_of(fit));
  return summary;
}

std::string summary_text(std::span<const TableSummary> tables, const fit::Options& options) {
  const std::vector<std::string> names = row_names(tables);
  const ColumnWidths widths = widths_of(tables, names);
  std::string text = heading(tables, widths, options);
  for (std::size_t i = 0; i < tables.size(); ++i) text += row_of(names[i], tables[i], widths);
  const auto failed = std::count_if(tables.begin(), tables.end(),
                                    [](const TableSummary& t) { return !t.error.empty(); });
  return text + fmt::format("\n{} of {} tables fitted; {} failed\n",
                            std::ptrdiff_t(tables.size()) - failed, tables.size(), failed);
}

}  // namespace gonio::app
