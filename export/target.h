// The list of what a material can be exported to.
#pragma once

#include <span>
#include <string>

#include "export/exported.h"
#include "material/material.h"

namespace gonio::exports {

struct Target {
  std::string name;     // as users write it
  std::string ending;   // of the file, with its dot
  std::string summary;  // one line
  /// `stem` is that of the file's name, for targets of several files, which name one another.
  /// Throws table::FileError for a material that the target cannot hold in any way.
  Exported (*write)(const material::Material& material, const std::string& stem);
};

/// All targets, by name.
std::span<const Target> all_targets();

/// The target of that name. Throws std::invalid_argument that lists the targets and suggests the
/// one that was probably meant.
const Target& target_named(const std::string& name);

}  // namespace gonio::exports
