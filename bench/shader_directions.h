// Pairs of directions as a shader receives them, in float, where its errors would show: all over
// the hemispheres, about the mirror direction as closely as a lobe is narrow, at grazing angles up
// to 89.99 degrees, at the normal itself, mirrored and on top of each other exactly, on the horizon
// and below it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bench/shader_materials.h"
#include "brdf/direction.h"

namespace gonio::bench {

using brdf::DirectionPair;

/// The pairs for a material's lobes; the same seed gives the same ones. Unit to rounding, and
/// exactly mirrored where they are nearly so and the material is a mirror: of 1e-5 rad and less
/// from the mirror direction float and double hold different vectors for mirrored.
std::vector<DirectionPair<double>> shader_directions(const ShaderMaterial& material,
                                                     std::size_t count, std::uint64_t seed);

}  // namespace gonio::bench
