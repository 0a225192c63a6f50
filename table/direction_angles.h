// From a direction to the angles that it is written as.
#pragma once

#include "brdf/direction.h"

namespace gonio::table {

/// Polar angle, 0 to 180, and azimuth, -180 to below 360, in degrees.
struct AnglesDeg {
  double theta, phi;
};

/// The angles of a unit vector. brdf::direction_from_degrees() makes the same bits of them where
/// angles with at most nine decimals do, as instruments write them: those are found again. Else the
/// direction is the same to 1e-15. At the pole phi is 0.
AnglesDeg angles_of(const brdf::Direction<double>& d);

}  // namespace gonio::table
