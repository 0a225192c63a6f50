// The function of a typical material of a model, in HLSL, by every path that the model has:
// computed, and with each of its look-up tables.
#pragma once

#include <string>
#include <vector>

#include "brdf/model.h"

namespace gonio::bench {

struct MaterialFunction {
  std::string path;  // "analytic", "ward-exponent, sqrt"
  bool reads_table;
  /// As material_pixel_shader() takes it.
  std::string text;
};

/// `header`: of shader::SourceText. Each table is that of lut::layout_for(), with the coordinates
/// cosine and sqrt where it has one.
std::vector<MaterialFunction> material_functions(const brdf::Model& model,
                                                 const std::vector<std::string>& header);

}  // namespace gonio::bench
