// Reading a table for a command that writes one.
#pragma once

#include <string>

#include "apps/gonio/table_options.h"
#include "table/sample_table.h"

namespace gonio::app {

/// Reads `path` with the text of its angles and its sha256, takes the part that the options say,
/// and prints the notes on stderr.
table::SampleTable read_for_writing(const std::string& path, const TableOptions& options);

}  // namespace gonio::app
