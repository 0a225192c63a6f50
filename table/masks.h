// Masking samples that the instrument could not measure, as the user knows it: the file does not
// tell.
#pragma once

#include <cstddef>

#include "brdf/direction.h"
#include "table/sample_table.h"

namespace gonio::table {

/// Masks the samples whose light and viewer are less than `degrees` apart as `retro`: there the
/// detector stands in the beam. Returns how many there are that were not masked before.
std::size_t mask_retro(SampleTable& table, double degrees);

/// Masks the samples whose viewer is less than `degrees` from `wo` as `blind_spot`. Returns how
/// many there are that were not masked before.
std::size_t mask_blind_spot(SampleTable& table, const brdf::Direction<double>& wo, double degrees);

}  // namespace gonio::table
