// Quotients that are too large for the type: they saturate instead of overflowing.
#pragma once

#include <concepts>
#include <limits>

#include "brdf/scalar.h"

namespace gonio::brdf {

/// The smaller of `quotient` and the largest finite number of D; S is the scalar that it will be
/// multiplied with. Where S carries derivatives the largest is smaller by 2^64: a derivative may
/// exceed its value by that much, by 1/(1 - s) for instance, and is to stay finite as well.
template <class S, class D>
D saturated(const D& quotient) {
  constexpr double room = std::same_as<S, D> ? 1 : 0x1p-64;
  const D largest = D((std::numeric_limits<D>::max)()) * D(room);
  return select(less(quotient, largest), quotient, largest);
}

}  // namespace gonio::brdf
