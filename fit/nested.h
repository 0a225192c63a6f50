// Models that are special cases of others: does the data ask for the richer one?
#pragma once

#include <span>

#include "fit/fit.h"

namespace gonio::fit {

/// Above this p-value the richer model is no better beyond chance.
inline constexpr double nested_significance = 0.05;

/// Sets FitResult::nested of each isotropic model whose anisotropic relative (each lobe the same,
/// but with its own roughness along and across the tangent) is among the results: Wald's test of
/// alpha_x = alpha_y in the anisotropic fit, with that fit's covariance and degrees of
/// freedom (F distribution).
void compare_nested(std::span<FitResult> results);

}  // namespace gonio::fit
