// The losses: what the square s = (r / scale)^2 of a residual costs.
#pragma once

#include <cmath>

#include "brdf/scalar.h"
#include "fit/options.h"

namespace gonio::fit {

/// rho(s) with rho(0) = 0 and rho'(0) = 1, concave: none of them counts a residual for more than
/// its square. Scalar S: double or brdf::Pack.
template <class S>
struct LossValue {
  S rho;
  S slope;      // rho'(s): the weight of the residual's square
  S influence;  // rho'(s) + 2 s rho''(s): the derivative of r rho'(s) by r
};

/// A loss and its scale, in the unit of the residuals.
struct ScaledLoss {
  Loss loss = Loss::none;
  double scale = 1;

  template <class S>
  LossValue<S> operator()(const S& s) const {
    using brdf::larger;
    using brdf::less;
    using brdf::select;
    using std::log;
    using std::sqrt;
    switch (loss) {
      case Loss::none:
        break;
      case Loss::huber: {
        const auto inside = less(s, S(1));
        const S root = sqrt(larger(S(1), s));
        return {select(inside, s, S(2) * root - S(1)), S(1) / root, select(inside, S(1), S(0))};
      }
      case Loss::cauchy: {
        const S t = S(1) + s;
        return {log(t), S(1) / t, (S(1) - s) / (t * t)};
      }
      case Loss::tukey: {
        const S t = larger(S(0), S(1) - s);
        return {(S(1) - t * t * t) / S(3), t * t,
                t * (S(1) - S(5) * select(less(s, S(1)), s, S(0)))};
      }
    }
    return {s, S(1), S(1)};
  }
};

/// The scale, in standard deviations of normal residuals, at which the loss is 95 % as efficient as
/// least squares (Holland & Welsch 1977).
inline double efficient_scale(Loss loss) {
  switch (loss) {
    case Loss::huber:
      return 1.345;
    case Loss::cauchy:
      return 2.385;
    case Loss::tukey:
      return 4.685;
    case Loss::none:
      break;
  }
  return 1;
}

}  // namespace gonio::fit
