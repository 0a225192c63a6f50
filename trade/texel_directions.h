// The directions that meet a look-up table where it errs the most: at its texels, half way between
// them, and for tables of up to 512 texels at the quarters, of up to 128 at the eighths.
//
// Half way a linear filter is the furthest from a parabola, at a quarter from a square root. A GPU
// rounds its weights to 1/256, and is the furthest off 1/512 of a texel beside such a place: it is
// met there, on both sides.
//
//   lobe tables    for every such w = 1 - n.h the half vector at the azimuths whose alphas are the
//                  rows and the middles between rows (one row: alphas evenly spaced in the
//                  logarithm); light at 0, 15, .. 75 deg, and the two viewers between which all
//                  others are, those of the smallest and the largest angle up to 80 deg
//   strauss-j      for every such w of wi up to 75 deg those w of wo up to 80 deg in the plane of
//                  incidence: all close to the mirror direction, fewer further away
//   strauss-terms  none: a material reads it at one place
#pragma once

#include <vector>

#include "brdf/bound_model.h"
#include "brdf/direction.h"
#include "lut/layout.h"

namespace gonio::trade {

/// All of them, or every so many. Where the axes of a lobe's table and the incidences are more than
/// some 100000 pairs, every texel of the first axis is met by some of the rows and incidences.
std::vector<brdf::DirectionPair<double>> texel_directions(const brdf::BoundModel& model,
                                                          const lut::Layout& layout,
                                                          std::size_t every = 1);

}  // namespace gonio::trade
