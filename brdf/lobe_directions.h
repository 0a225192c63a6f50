// Directions that show a lobe whatever its width: dense where the viewer is near the mirror
// direction of the light, and covering the hemisphere.
//
// They are half vectors on a grid, azimuth psi times t = tan of the angle from the normal with
// equal steps of ln t, and wo is the mirror image of wi at each. A lobe of width alpha lies between
// t = alpha / 10 and 3 alpha for any alpha. With the solid angle that each stands for a sum over
// them is an integral over the hemisphere: dwo = 4 (wi.h) dwh and, for a unit h, dwh = sin^2 cos
// dln(t) dpsi.
#pragma once

#include <vector>

#include "brdf/direction.h"

namespace gonio::brdf {

/// A direction and the solid angle in sr that it stands for.
struct SolidAngleDirection {
  Direction<double> direction;
  double solid_angle;
};

/// How dense the grid of half vectors is.
struct LobeResolution {
  /// Steps of t per factor e, from `narrowest` on; a disc around the normal is one direction more.
  int steps_per_e = 10;
  /// Over the whole circle.
  int azimuths = 24;
  double narrowest = 1e-5;
};

/// The directions wo above the horizon for the unit vector `wi` above it; wi's mirror direction is
/// the first. Their solid angles add up to 2 pi within 2 %, and sums over a lobe agree with the
/// integral to 2e-3 up to 75 deg. Throws std::invalid_argument for a wi
/// that is not above the horizon.
std::vector<SolidAngleDirection> lobe_directions(const Direction<double>& wi,
                                                 const LobeResolution& resolution = {});

}  // namespace gonio::brdf
