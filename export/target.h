// The list of what a material can be exported to.
#pragma once

#include <span>
#include <string>

#include "export/exported.h"
#include "export/shader_table.h"
#include "material/material.h"

namespace gonio::exports {

struct Target {
  std::string name;     // as users write it
  std::string ending;   // of the file, with its dot
  std::string summary;  // one line
  /// `stem` is that of the file's name, for targets of several files, which name one another.
  /// Throws table::FileError for a material that the target cannot hold in any way.
  Exported (*write)(const material::Material& material, const std::string& stem);
  /// The same with what the table holds read from it; null for targets that read none. Throws
  /// std::invalid_argument for a table of another material.
  Exported (*write_with_table)(const material::Material& material,
                               const ShaderTable& table) = nullptr;
};

/// All targets, by name.
std::span<const Target> all_targets();

/// The target of that name. Throws std::invalid_argument that lists the targets and suggests the
/// one that was probably meant.
const Target& target_named(const std::string& name);

}  // namespace gonio::exports
