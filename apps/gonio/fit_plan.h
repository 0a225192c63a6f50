// Which files a run of gonio fit reads and writes, checked before the work.
//
// Several tables, --summary, or an -o that is a folder make a batch: -o and --residuals are folders
// then, which get NAME.json and NAME.csv for each table, NAME being its file name without
// extension.
#pragma once

#include <string>
#include <vector>

#include "apps/gonio/fit_arguments.h"

namespace gonio::app {

/// One table and what is written for it. Empty: not asked for.
struct FitFiles {
  std::string table;
  std::string material;
  std::string residuals;
};

struct FitPlan {
  bool is_batch = false;
  std::vector<FitFiles> tables;
  /// Where the summary goes as CSV; empty: to no file.
  std::string summary;
};

/// Throws std::invalid_argument for two tables whose outputs would have one name, for an output
/// that would overwrite a table or another output, and for options that exclude each other.
FitPlan plan_in(const FitArguments& arguments);

/// Creates the folders that are missing and tries every output. Throws std::invalid_argument where
/// a file is in a folder's place, table::FileError where something cannot be written.
void prepare_outputs(const FitArguments& arguments, const FitPlan& plan);

}  // namespace gonio::app
