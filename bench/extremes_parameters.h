// Parameters at the extremes of their ranges and inside, drawn from the terms' descriptors alone.
#pragma once

#include <span>

#include "bench/random_source.h"
#include "brdf/parameter.h"

namespace gonio::bench {

/// How near to a bound "almost at the bound" is, in units of the parameter.
inline constexpr double nearest_to_bound = 1e-7;

/// A shape parameter: a bound, within 1e-7 of one, or inside, over the range that its scale walks
/// along.
double draw_shape_parameter(RandomSource& random, const brdf::Parameter& parameter);

/// Shape parameters, one per descriptor; every fourth time the two of an anisotropic lobe differ by
/// a factor of 1000.
void draw_shape(RandomSource& random, std::span<const brdf::Parameter> parameters,
                std::span<double> shape);

/// Amplitudes, one per descriptor: between the bounds, or every other time one of them. Without an
/// upper bound an amplitude only scales the term, and stays away from 0.
void draw_amplitudes(RandomSource& random, std::span<const brdf::Parameter> parameters,
                     std::span<double> amplitudes);

}  // namespace gonio::bench
