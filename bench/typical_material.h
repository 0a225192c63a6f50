// A material of a model with parameters of which no shader compiler can make less: none is 0 or 1,
// no two are the same.
#pragma once

#include "brdf/bound_model.h"

namespace gonio::bench {

/// In three channels. Throws std::logic_error for a parameter that it has no value for.
brdf::BoundModel typical_material(const brdf::Model& model);

}  // namespace gonio::bench
