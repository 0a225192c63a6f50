// A table of numbers that does not say what it holds: CSV as spreadsheets and instruments' software
// write it. The user says it: ReadOptions::columns, quantity and angles.
//
// Title lines may precede; the last line in front of the first row of numbers names the columns.
// Columns are separated by commas, semicolons, tabs or blanks, as that row shows.
//
// ReadOptions::columns lists every column in the file's order, comma-separated: theta_i, phi_i,
// theta_o, phi_o (or an alias: columns.h), sigma_<channel>, weight, a channel's name, or - for one
// to pass over. An angle that no column holds may be given as a constant, such as phi_i=0. Without
// the list the file's own names are taken. A unit behind an angle's name (theta_i_deg) is known.
#pragma once

#include <string>
#include <string_view>

#include "table/read.h"
#include "table/sample_table.h"

namespace gonio::table {

/// True if a row of at least three numbers stands in the first 4096 bytes.
bool is_foreign_csv(std::string_view content);

/// Parses such a table. Throws FileError, also where `options` do not say what is needed: the
/// message names the missing option and the line that a gonio-table would have for it.
SampleTable read_foreign_csv(std::string_view content, const std::string& path,
                             const ReadOptions& options);

/// The directions alone of a gonio-table or a foreign CSV: a table without channels, with the
/// angles' text. Other columns are passed over, and quantity is not asked for. Throws FileError.
SampleTable read_directions(const std::string& path, const ReadOptions& options);

}  // namespace gonio::table
