// What commands that read a table share: how to read it, and which part of it to take.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "table/read.h"
#include "table/sample_table.h"

namespace gonio::app {

/// The texts of the command line.
struct TableOptions {
  std::string columns, quantity, angles;
  std::string material;
  std::string channels;
  std::string mask_retro;
  std::vector<std::string> mask_wo;
};

/// Adds --columns, --quantity, --angles and --material: how a file is read that does not say it.
void add_reading_options(CLI::App& command, TableOptions& options);
/// Adds those and --channels, --mask-retro and --mask-wo: which part of the table is taken.
void add_table_options(CLI::App& command, TableOptions& options);

/// `base` with the options for reading. Throws std::invalid_argument that names the option.
table::ReadOptions reading_options(const TableOptions& options, table::ReadOptions base = {});

/// Leaves the table with the chosen channels and masks what the options say; a note on the table
/// tells how many samples. Throws std::invalid_argument.
void take_part(table::SampleTable& table, const TableOptions& options);

/// Reads the table `path` and takes the part of it.
table::SampleTable read_table(const std::string& path, const TableOptions& options,
                              const table::ReadOptions& base = {});

}  // namespace gonio::app
