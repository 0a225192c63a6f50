// What an OpenMATERIAL 3D table holds, by directions and channels.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "table/formats/openmaterial_grid.h"

namespace gonio::table {

struct OpenMaterialContents {
  std::string name;
  std::vector<std::string> channels;
  std::vector<RelativeAngles> angles;       // of each direction, in the order of the rows
  std::vector<std::vector<double>> values;  // [channel][direction], NaN where there is none
  std::vector<std::vector<bool>> has_row;   // [channel][direction]
  std::size_t negative = 0;                 // values
  std::vector<std::string> notes;
};

/// Reads a file: a channel per wavelength that has rows, in the order in which the file lists them.
/// Throws FileError, also for wavelengths that stand twice or are not listed, to 1e-6, and for
/// directions that stand twice.
OpenMaterialContents read_openmaterial_contents(std::string_view content, const std::string& path);

}  // namespace gonio::table
