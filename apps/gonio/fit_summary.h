// What a batch of gonio fit found, without the tables themselves: as text and as CSV.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/gonio/fit_table.h"
#include "fit/options.h"

namespace gonio::app {

struct ParameterEstimate {
  std::string name;  // "rho_d.R", "alpha_x"
  double value;
  std::optional<double> stddev;
};

/// One model fitted to one table.
struct ModelSummary {
  std::string model;
  fit::Metric metric;
  std::string loss;
  std::size_t used;
  bool converged;
  double metric_error;
  std::optional<double> held_out_error;  // like metric_error
  std::vector<std::pair<std::string, double>> errors;
  std::size_t warnings;
  std::vector<ParameterEstimate> parameters;
};

struct TableSummary {
  std::string table;
  /// Why it failed, beginning with the table's path; empty if it did not.
  std::string error = {};
  /// Best first; none if it failed.
  std::vector<ModelSummary> fits = {};

  /// It did not fail, and every fit converged.
  bool is_good() const;
};

TableSummary summary_of(const TableFit& table_fit);

/// A row per table with its best model, in the order given, and a last line that counts.
std::string summary_text(std::span<const TableSummary> tables, const fit::Options& options);

/// CSV (RFC 4180, but with plain newlines) with a row per fitted model and one per failed table, in
/// the order given: table, model, rank, metric, loss, used, converged, the error under each
/// metric, metric_error and held_out, the number of warnings, the error message of a failed table,
/// then value and standard deviation of each parameter that occurs; empty where a model has none.
/// Doubles read back to the same bits.
std::string summary_csv(std::span<const TableSummary> tables);

}  // namespace gonio::app
