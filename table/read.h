// Reading a table of whatever format: the format is told by the content, never by the ending.
#pragma once

#include <optional>
#include <string>

#include "table/gridded_table.h"
#include "table/sample_table.h"

namespace gonio::table {

struct ReadOptions {
  /// Keep each row's angles as the file wrote them, for commands that echo a table.
  bool keep_angle_text = false;
  /// Threads for parsing; 0: as many as the machine has. The result has the same bits for any.
  int threads = 0;
  /// For a CSV that does not say what its columns, numbers and angles are (foreign_csv.h). A format
  /// that says so itself refuses them.
  std::string columns = {};
  std::optional<Quantity> quantity = {};
  std::optional<AngleUnit> angles = {};
  /// Which material of a file that holds several (CUReT), by its number; needed for such a file,
  /// refused for others.
  std::optional<int> material = {};
};

/// Reads `path`. Throws FileError when it is no readable file, no known format, or not valid.
/// The sha256 of the bytes is left empty here: see sha256_of_file().
SampleTable read(const std::string& path, const ReadOptions& options = {});

/// Reads `path` as a function of direction. Throws FileError as read() does, and for a format whose
/// samples stand on no grid.
GriddedTable read_gridded(const std::string& path, const ReadOptions& options = {});

/// The SHA-256 of the file's bytes in lower-case hexadecimal; empty for a pipe, whose bytes are
/// gone once they were read. Throws FileError.
std::string sha256_of_file(const std::string& path);

}  // namespace gonio::table
