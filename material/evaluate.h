// A material's f_r, for a pair of directions or for all the directions of a table.
#pragma once

#include <vector>

#include "brdf/bound_model.h"
#include "material/material.h"
#include "table/sample_table.h"

namespace gonio::material {

/// The material's model, with a free frame if a tangent angle is among the parameters. Throws
/// std::invalid_argument for an unknown model.
brdf::Model model_of(const Material& material);

/// The material's model with its values, to be evaluated many times. Throws std::invalid_argument
/// for an unknown model or values that do not suit it.
brdf::BoundModel bind(const Material& material);

/// f_r in 1/sr, [channel of the material][sample], for every sample of the table, masked or not;
/// 0 at the horizon. The table's own channels and values play no part.
std::vector<std::vector<double>> evaluate(const Material& material,
                                          const table::SampleTable& table);

}  // namespace gonio::material
