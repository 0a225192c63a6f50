// How sure a fitted material's f_r is: the uncertainty of its parameters, carried through the model
// to first order. With the gradient g of f_r by the parameters and their covariance C the variance
// of f_r is g'C g.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "brdf/direction.h"
#include "material/material.h"

namespace gonio::trade {

/// The standard deviation of f_r in 1/sr, [pair][channel]; nothing where no fit stands behind the
/// material. A parameter without standard deviation, which was fixed or which the data could not
/// determine, counts as known. The gradient is by central differences, one-sided at a bound. Throws
/// as material::bind.
std::optional<std::vector<double>> parameter_uncertainty(
    const material::Material& material, std::span<const brdf::DirectionPair<double>> pairs);

}  // namespace gonio::trade
