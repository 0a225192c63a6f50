// Directions that show a lobe whatever its width: dense where the viewer is near the mirror
// direction of the light, and covering the hemisphere.
//
// They are half vectors on a grid in polar coordinates about the normal, and wo is the mirror image
// of wi at each. Near the normal the angle delta of the rings grows by a constant factor, so that a
// lobe of any width lies between delta = alpha / 10 and 3 alpha; further out the rings are a
// constant angle apart, so that the viewer moves by little: u = A ln(delta) + B delta is what has
// equal steps. With the solid angle that each direction stands for a sum over them is an integral
// over the hemisphere: dwo = 4 (wi.h) dwh and dwh = sin(delta) ddelta dpsi for a unit h. The
// azimuth psi is counted from the plane of incidence, which holds two columns of the grid.
#pragma once

#include <vector>

#include "brdf/direction.h"

namespace gonio::brdf {

/// A direction and the solid angle in sr that it stands for.
struct SolidAngleDirection {
  Direction<double> direction;
  double solid_angle;
};

/// How dense the grid of half vectors is, and how much of it there is.
struct LobeResolution {
  /// Near the normal: rings per factor e of the angle, from `narrowest` radians on; the disc within
  /// is one direction more.
  double rings_per_e = 5;
  /// Far from it: rings per radian; the viewer moves by at most two of them at a time.
  double rings_per_radian = 80;
  /// Over the whole circle; even.
  int azimuths = 44;
  double narrowest = 1e-5;
  /// Only one side of the plane of incidence, which stands for both: for what is the same on both.
  bool one_side = false;
};

/// The directions wo above the horizon for the unit vector `wi` above it; wi's mirror direction is
/// the first and is met by no other. Their solid angles add up to 2 pi within 2 %, and sums over a
/// lobe agree with the integral to 2e-3 up to 75 deg. Throws std::invalid_argument for a wi that is
/// not above the horizon.
std::vector<SolidAngleDirection> lobe_directions(const Direction<double>& wi,
                                                 const LobeResolution& resolution = {});

}  // namespace gonio::brdf
