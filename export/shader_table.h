// A look-up table beside an exported shader: what texture has to be bound, and what it costs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "brdf/bound_model.h"
#include "lut/table.h"
#include "material/comparison.h"

namespace gonio::exports {

/// A baked table and the name of its file, without a folder: exported texts are handed on.
struct ShaderTable {
  lut::Table table;
  std::string file;
};

/// Reads a table that `gonio lut bake` wrote. Throws table::FileError for a file that is none.
ShaderTable read_shader_table(const std::string& path);

/// What the author of a shader has to bind and how it is sampled, for the comment at its top: lines
/// without comment signs.
std::vector<std::string> texture_lines(const ShaderTable& table);

/// How far the model with its lobes read from the table, as a GPU filters it (linearly, with
/// weights of 1/256), is from the model itself. Throws std::invalid_argument as lut::TableModel.
material::Difference table_loss(const brdf::BoundModel& model,
                                const std::vector<std::string>& channels, const lut::Table& table);

}  // namespace gonio::exports
