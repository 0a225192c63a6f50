// The directions at which an evaluator is compared with its model where there are no samples:
// incidence 0, 15, .. 75 deg, and half vectors dense in the lobe, both angles up to 80 deg.
//
// Lobes up to 6 times as wide one way as the other are shown by brdf/lobe_directions.h. Of a more
// stretched Ward lobe the part within 4 alpha, which is all of it, has a grid of its own: polar
// coordinates r, psi of the slopes hx/hz = alpha_x r cos(psi), hy/hz = alpha_y r sin(psi), with
// dwh = (n.h)^3 alpha_x alpha_y r dr dpsi and dwo = 4 (wi.h) dwh.
#pragma once

#include <vector>

#include "brdf/bound_model.h"
#include "brdf/direction.h"

namespace gonio::trade {

/// A pair of directions and the solid angle in sr that its wo stands for.
struct WeightedPair {
  brdf::DirectionPair<double> pair;
  double weight;
};

/// Four azimuths of the light for a model with a tangent, one for the others.
std::vector<WeightedPair> lobe_grid(const brdf::BoundModel& model);

}  // namespace gonio::trade
