// What the lobes about the half vector share: exponentials that stay within the range of the
// numbers, and the power of the half vector's cosine without the rounding of that cosine.
#pragma once

#include <cmath>
#include <limits>
#include <string_view>

#include "brdf/direction.h"
#include "brdf/parameter.h"
#include "brdf/scalar.h"

namespace gonio::brdf {

/// exp(-exponent) / denominator: 0 where the numerator underflows, whatever the denominator, and
/// the largest finite number where the quotient overflows. Never NaN.
template <class D, class S>
S exponential_over(const S& exponent, const S& denominator) {
  using std::exp;
  // -log of the smallest positive number: beyond it exp() is 0 and 0/0 would be NaN.
  constexpr double underflow = std::numeric_limits<D>::max_exponent <= 128 ? 103.9 : 745.1;
  const S largest((std::numeric_limits<D>::max)());
  const S value = exp(-exponent) / denominator;
  return select(less(exponent, S(D(underflow))), select(less(value, largest), value, largest),
                S(D(0)));
}

/// |v| for a vector that points above the horizon, also where its squares would underflow.
template <class D>
D length_above_horizon(const Direction<D>& v) {
  using std::abs;
  using std::sqrt;
  const D scale = larger(larger(D(abs(v.x)), D(abs(v.y))), v.z);
  const D x = v.x / scale;
  const D y = v.y / scale;
  const D z = v.z / scale;
  return scale * sqrt(x * x + y * y + z * z);
}

/// -ln(n.h) of the unnormalised half vector h above the horizon, whose length is given: from 0 at
/// the normal to 745 at the horizon. (n.h)^e is exp(-e * this).
///
/// (n.h)^-2 = 1 + q, q = (hx^2 + hy^2) / hz^2, is exact to rounding where n.h, which moves in steps
/// of 6e-8 in float, is 1. Where q is large, and may overflow, n.h has all its digits.
template <class D>
D minus_log_cosine(const Direction<D>& h, const D& length) {
  using std::log;
  using std::log1p;
  const D x = h.x / h.z;
  const D y = h.y / h.z;
  const D q = x * x + y * y;
  return select(less(q, D(1)), D(log1p(q) / D(2)), D(-log(h.z / length)));
}

/// The exponent of a cosine lobe, under the given name.
constexpr Parameter cosine_exponent(std::string_view name, std::string_view meaning,
                                    std::string_view source) {
  return {.name = name,
          .unit = "1",
          .lower = 0,
          .upper = 1e6,
          .search_lower = 1,
          .search_upper = 1e4,
          .scale = Scale::logarithmic_from_one,
          .meaning = meaning,
          .source = source};
}

}  // namespace gonio::brdf
