// The project's own table: CSV with a `# gonio-table 1` header. See docs/formats.md.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "table/read.h"
#include "table/sample_table.h"

namespace gonio::table {

/// True if the content starts like a gonio-table (a byte order mark and blank lines may precede).
bool is_gonio_csv(std::string_view content);

/// Parses a gonio-table. `path` is for messages and provenance. Throws FileError.
SampleTable read_gonio_csv(std::string_view content, const std::string& path,
                           const ReadOptions& options);

/// The directions of a gonio-table: a table without channels. Any other column is passed over, and
/// there need be none, nor a quantity.
SampleTable read_gonio_directions(std::string_view content, const std::string& path,
                                  const ReadOptions& options);

/// A further column of an echoed table: one value per sample, in f_r (1/sr).
struct ExtraColumn {
  std::string name;
  std::span<const double> values;
};

/// Writes `table` as a gonio-table of quantity brdf through `write`, in pieces. Angles are
/// the table's own text where it was kept, else degrees that read back to the same direction to
/// rounding. Holes are empty fields, and so is what was extrapolated and a NaN of an extra column.
/// Numbers have the fewest digits that read back to the same bits. The extra columns follow the
/// channels: a reader of the result takes them for channels. Samples with a direction below the
/// horizon, which gridded formats have and this one has not, are left out.
void write_gonio_csv(const SampleTable& table, std::span<const ExtraColumn> extra_columns,
                     const std::function<void(std::string_view)>& write);

/// What a gonio-table CSV of `table` does not hold, a sentence each.
std::vector<std::string> csv_losses(const SampleTable& table);

}  // namespace gonio::table
