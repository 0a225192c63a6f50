// The Cramer-Rao bound: the smallest standard deviation that an unbiased estimate of a parameter
// can have (Rao 1945, Cramer 1946).
//
// The values are normal with the known standard deviations sigma, so the Fisher information is
// J'J, J being the Jacobian of f_r / sigma at the truth, and the bounds are the roots of the
// diagonal of its inverse. That sigma follows f_r and could tell of the parameters as well is left
// unused, by the bound as by every fit here.
#pragma once

#include <vector>

#include "instrument/recipe.h"

namespace gonio::bench {

/// The bound of every unknown of the recipe's model, in the order of fit::unknowns_of() and in the
/// unit of the parameter. Nothing of a fit is in it: the model is tests/ward_reference.h in 50
/// decimal digits, the Jacobian its central differences.
///
/// The model has to be Lambert's diffuse and one of Ward's lobes, the noise not 0; throws
/// std::invalid_argument else.
std::vector<double> cramer_rao_bounds(const instrument::Recipe& recipe);

}  // namespace gonio::bench
