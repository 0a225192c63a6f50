// Rusinkiewicz's coordinates of a pair of directions: where their half vector h lies, and where wi
// lies in the frame of h. Source: Rusinkiewicz, A New Change of Variables for Efficient BRDF
// Representation, Eurographics Workshop on Rendering 1998.
#pragma once

#include "brdf/direction.h"

namespace gonio::table {

/// Radians. Swapping wi and wo adds pi to phi_d; an isotropic material does not depend on phi_h.
struct HalfDifference {
  double theta_h;    // of h from the normal
  double phi_h = 0;  // of h from x towards y
  double theta_d;    // of wi from h, and of wo
  double phi_d;      // of wi about h: 0 where wi leans away from the normal
};

/// The unit directions with these coordinates; either may lie below the horizon.
brdf::DirectionPair<double> directions_from(const HalfDifference& coordinates);

/// The coordinates of unit directions, accurate to the rounding of their components; theta_h and
/// theta_d at least 0, azimuths in [-pi, pi]. The azimuth of h is 0 where h would be the normal if
/// either direction were turned by `tolerance` radians. phi_d means nothing where theta_d is 0.
HalfDifference half_difference(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                               double tolerance);

}  // namespace gonio::table
