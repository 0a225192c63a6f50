// The summary of a batch as CSV, as RFC 4180 describes it, but with plain newlines.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

#include "apps/gonio/fit_summary.h"

namespace gonio::app {
namespace {

// As in fit::ErrorList.
constexpr std::array<std::string_view, 5> error_names{"l2", "cosine-l2", "log", "cube-root",
                                                      "relative"};

/// A field as RFC 4180 writes it: in quotes where it holds a comma, a quote or a line end.
std::string quoted_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + '"';
}

std::string line_of(const std::vector<std::string>& fields) {
  std::vector<std::string> quoted;
  for (const std::string& field : fields) quoted.push_back(quoted_field(field));
  return fmt::format("{}\n", fmt::join(quoted, ","));
}

/// The parameters of all fits in the order in which they first occur.
std::vector<std::string> parameter_names(std::span<const TableSummary> tables) {
  std::vector<std::string> names;
  std::set<std::string_view> known;
  for (const TableSummary& table : tables) {
    for (const ModelSummary& fit : table.fits) {
      for (const ParameterEstimate& parameter : fit.parameters) {
        if (known.insert(parameter.name).second) names.push_back(parameter.name);
      }
    }
  }
  return names;
}

std::string csv_header(const std::vector<std::string>& parameters) {
  std::vector<std::string> fields{"table", "model", "rank", "metric", "loss", "used", "converged"};
  fields.insert(fields.end(), error_names.begin(), error_names.end());
  fields.insert(fields.end(), {"metric_error", "held_out", "warnings", "error"});
  for (const std::string& name : parameters) {
    fields.push_back(name);
    fields.push_back(name + "_stddev");
  }
  return line_of(fields);
}

std::string csv_row_of_failed(const TableSummary& table, std::size_t parameter_count) {
  // model, rank, metric, loss, used, converged; the errors; metric_error, held_out, warnings
  constexpr std::size_t fields_of_a_fit = 6 + error_names.size() + 3;
  std::vector<std::string> fields{table.table};
  fields.resize(1 + fields_of_a_fit);
  fields.push_back(table.error);
  fields.resize(fields.size() + 2 * parameter_count);
  return line_of(fields);
}

std::string error_text(const ModelSummary& fit, std::string_view name) {
  const auto found = std::find_if(fit.errors.begin(), fit.errors.end(),
                                  [&](const auto& error) { return error.first == name; });
  return found == fit.errors.end() ? "" : fmt::format("{}", found->second);
}

std::string text_of(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "";
}

std::string csv_row_of(const TableSummary& table, std::size_t rank,
                       const std::vector<std::string>& parameters) {
  const ModelSummary& fit = table.fits[rank];
  std::vector<std::string> fields{table.table,
                                  fit.model,
                                  fmt::format("{}", rank + 1),
                                  std::string(name(fit.metric)),
                                  fit.loss,
                                  fmt::format("{}", fit.used),
                                  fit.converged ? "true" : "false"};
  for (const std::string_view name : error_names) fields.push_back(error_text(fit, name));
  fields.push_back(fmt::format("{}", fit.metric_error));
  fields.push_back(text_of(fit.held_out_error));
  fields.push_back(fmt::format("{}", fit.warnings));
  fields.emplace_back();  // error
  std::map<std::string_view, const ParameterEstimate*> estimates;
  for (const ParameterEstimate& parameter : fit.parameters) estimates[parameter.name] = &parameter;
  for (const std::string& name : parameters) {
    const auto found = estimates.find(name);
    const ParameterEstimate* estimate = found == estimates.end() ? nullptr : found->second;
    fields.push_back(estimate != nullptr ? fmt::format("{}", estimate->value) : "");
    fields.push_back(estimate != nullptr ? text_of(estimate->stddev) : "");
  }
  return line_of(fields);
}

}  // namespace

std::string summary_csv(std::span<const TableSummary> tables) {
  const std::vector<std::string> parameters = parameter_names(tables);
  std::string csv = csv_header(parameters);
  for (const TableSummary& table : tables) {
    if (!table.error.empty()) csv += csv_row_of_failed(table, parameters.size());
    for (std::size_t i = 0; i < table.fits.size(); ++i) csv += csv_row_of(table, i, parameters);
  }
  return csv;
}

}  // namespace gonio::app
