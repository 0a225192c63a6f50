// What an export hands to whoever writes it to a disk: the text, and what was lost on the way.
#pragma once

#include <string>
#include <vector>

#include "material/comparison.h"

namespace gonio::exports {

/// One file of an export. The first bears the name that the user chose, and its `suffix` is empty;
/// the name of another is the stem of that name with its suffix, which holds its ending.
struct ExportedFile {
  std::string suffix;
  std::string text;
};

/// Below this peak and rms difference the target holds the material itself: the numbers in the file
/// have 12 digits.
inline constexpr double exact_difference = 1e-9;

struct Exported {
  std::vector<ExportedFile> files;
  /// How far the file's numbers, as the target evaluates them, are from the material.
  material::Difference loss;
  /// One line: which of the target's materials and parameters stand for the model; begins with
  /// "exact" where the target holds the model itself.
  std::string fitted_as;
  /// One sentence each, for the user; all of them stand in the file, too.
  std::vector<std::string> warnings;
};

}  // namespace gonio::exports
