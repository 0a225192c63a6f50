// gonio fit for one table: read it, fit the models, write its files.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/gonio/fit_messages.h"
#include "apps/gonio/fit_plan.h"
#include "apps/gonio/table_options.h"
#include "brdf/model.h"
#include "fit/fit.h"
#include "material/material.h"
#include "table/sample_table.h"

namespace gonio::app {

/// What is asked of every table.
struct FitRequest {
  fit::Options options;
  TableOptions reading;
  /// None: all the models that a table can determine.
  std::optional<std::vector<brdf::Model>> models;
  brdf::Frame frame = brdf::Frame::of_table;
  std::string command_line;
  /// The table's sha256 belongs to the result.
  bool with_digest = false;
};

struct ModelFit {
  fit::FitResult result;
  material::Material material;
  double seconds;  // of the fit, without those to parts of the table
};

struct TableFit {
  table::SampleTable table;
  double read_seconds;
  /// Best first, at least one.
  std::vector<ModelFit> fits;

  bool has_converged() const;
};

/// Reads the table, fits, and writes the files for the best model. Throws table::FileError for a
/// table that cannot be used or an output that cannot be written, std::invalid_argument for
/// options that do not fit this table.
TableFit fit_table(const FitRequest& request, const FitFiles& files, FitMessages& messages);

/// What the user should know before believing the best fit.
void note_warnings(const TableFit& table_fit, FitMessages& messages);

/// Each fit as material JSON with its timing, best first.
nlohmann::ordered_json json_of_fits(const TableFit& table_fit);

}  // namespace gonio::app
