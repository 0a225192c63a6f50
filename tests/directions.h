// Directions made from others, as the tests of several models need them.
#pragma once

#include "brdf/direction.h"

namespace gonio::tests {

/// The same direction in the type D, each component rounded.
template <class D>
brdf::Direction<D> as(const brdf::Direction<double>& d) {
  return {static_cast<D>(d.x), static_cast<D>(d.y), static_cast<D>(d.z)};
}

/// wi mirrored about the half vector of slopes hx/hz = x and hy/hz = y.
inline brdf::Direction<double> mirrored_about_slopes(const brdf::Direction<double>& wi, double x,
                                                     double y) {
  const double scale = 2 * (wi.x * x + wi.y * y + wi.z) / (x * x + y * y + 1);
  return {scale * x - wi.x, scale * y - wi.y, scale - wi.z};
}

}  // namespace gonio::tests
