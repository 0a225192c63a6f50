// Writes the project's compact table; the other direction of exr_table.cpp.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "table/sample_table.h"

namespace gonio::table {

struct ExrTableOptions {
  /// Numbers with all their bits; else with the 24 that FLOAT has, in about half the size.
  bool exact = true;
};

/// Writes `table` through `write`. Angles are in degrees. Returns what the file does not hold, a
/// sentence each. Throws FileError for channel names that no table may have, or for more than 2^31
/// - 1 samples.
std::vector<std::string> write_exr_table(const SampleTable& table, const ExrTableOptions& options,
                                         const std::function<void(std::string_view)>& write);

}  // namespace gonio::table
