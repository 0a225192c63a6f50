// Gonio-tables as text, for the tests of reading and writing them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "table/formats/gonio_csv.h"

namespace gonio::tests {

/// A header of the given quantity and unit with the columns that follow it.
inline std::string header(const std::string& quantity, const std::string& angles,
                          const std::string& columns) {
  return "# gonio-table 1\n# quantity: " + quantity + "\n# angles: " + angles + "\n" + columns +
         "\n";
}

/// The header of a table of two channels in degrees; four lines.
inline const std::string plain = header("brdf", "deg", "theta_i,phi_i,theta_o,phi_o,R,G");

/// What is written of a table.
inline std::string written(const table::SampleTable& table,
                           const std::vector<table::ExtraColumn>& extra_columns = {}) {
  std::string text;
  table::write_gonio_csv(table, extra_columns, [&](std::string_view piece) { text += piece; });
  return text;
}

}  // namespace gonio::tests
