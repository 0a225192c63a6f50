// ASTM E1392-style goniometer text: keyword lines, VARS with the column names, then rows.
#pragma once

#include <string>
#include <string_view>

#include "table/read.h"
#include "table/sample_table.h"

namespace gonio::table {

/// True if the content's first lines are keyword lines with a VARS line among them.
bool is_astm(std::string_view content);

/// Parses ASTM text. Recognises a VARS line that omits phi_s, angles in radians or degrees, and
/// a stretch before the horizon that the instrument's software filled with a ramp to zero
/// (masked as extrapolated); each is said in notes. Throws FileError.
SampleTable read_astm(std::string_view content, const std::string& path,
                      const ReadOptions& options);

}  // namespace gonio::table
