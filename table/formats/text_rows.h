// The rows of a text table: from lines of numbers to samples, in parallel.
//
// The text is cut into fixed blocks at line ends. A first pass counts the rows of each, so that
// a second one can write every number to its final place; neither depends on the thread count.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "table/formats/columns.h"
#include "table/read.h"
#include "table/sample_table.h"

namespace gonio::table {

enum class Separator { comma, blank, semicolon };

/// A text table behind its header.
struct TextRows {
  std::string_view text;   // begins with a line; `#` lines and blank lines are passed over
  std::size_t first_line;  // the number of that line in the file
  std::string path;
  Separator separator = Separator::comma;
  Columns columns;
};

/// The largest polar angle and the largest |azimuth| of the rows, as written. Fields that are no
/// numbers are passed over.
struct AngleExtent {
  double theta = 0;
  double phi = 0;
};
AngleExtent angle_extent(const TextRows& rows);

/// Reads the rows as samples of `quantity` and fills all of the table's arrays and channel
/// names. Throws FileError for the first bad row of the file, whatever the number of threads.
void read_rows(const TextRows& rows, Quantity quantity, AngleUnit unit, const ReadOptions& options,
               SampleTable& table);

}  // namespace gonio::table
