// The polar angle of a direction above the horizon, measured from the surface normal.
//
// Never through acos of a cosine, which knows an angle of 1e-6 deg to one digit only: from both the
// sine and the cosine of the components, so that the angle keeps all digits at the pole and its
// distance from the horizon keeps them at grazing.
#pragma once

#include <cmath>

#include "brdf/direction.h"

namespace gonio::brdf {

/// sin(theta) = sqrt(x^2 + y^2), scaled: the squares of tiny components would underflow.
template <class D>
D polar_sine(const Direction<D>& w) {
  using std::abs;
  using std::sqrt;
  const D size = larger(D(abs(w.x)), D(abs(w.y)));
  const D scale = select(less(D(0), size), size, D(1));
  const D x = w.x / scale;
  const D y = w.y / scale;
  return scale * sqrt(x * x + y * y);
}

/// theta / (pi/2) for the angle with this sine and cosine: 0 at the normal, 1 on the horizon. With
/// the two exchanged it is 1 - theta / (pi/2).
template <class D>
D quarter_turns(const D& sine, const D& cosine) {
  using std::atan2;
  return atan2(sine, cosine) * (D(2) / pi<D>());
}

}  // namespace gonio::brdf
