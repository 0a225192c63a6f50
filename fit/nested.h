// Models that are special cases of others: does the data ask for the richer one?
#pragma once

#include <span>

#include "fit/fit.h"

namespace gonio::fit {

/// Sets FitResult::nested of each isotropic model whose anisotropic relative (each lobe the same,
/// but with its own roughness along and across the tangent) is among the results: Wald's test of
/// alpha_x = alpha_y in the anisotropic fit, with that fit's covariance.
void compare_nested(std::span<FitResult> results);

}  // namespace gonio::fit
