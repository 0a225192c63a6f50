// Writing a table in one of the formats that gonio writes, and telling what the format cannot hold.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "table/sample_table.h"

namespace gonio::app {

/// The texts of the command line.
struct TableOutput {
  std::string path;
  std::string format;  // csv, exr, merl or openmaterial; empty: as the path ends
  bool single = false;
  bool drop_sigma = false;
  bool drop_weight = false;
  std::string license, copyright, author;
};

/// Adds --to, --single, --drop-sigma, --drop-weight, and what OpenMATERIAL asks for.
void add_output_options(CLI::App& command, TableOutput& output);

/// Throws std::invalid_argument for a format that there is not, before anything is read.
void check_output(const TableOutput& output);

/// Writes `table`, without its sigma or weight where asked, beside the path, renames it, and says
/// on stderr what was written and what was lost. Throws table::FileError.
void write_table(table::SampleTable table, const TableOutput& output);

}  // namespace gonio::app
