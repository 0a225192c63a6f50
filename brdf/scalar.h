// What the formulas of the terms ask of a number beyond arithmetic. They are written without
// branches, so that one formula serves double, float, multi-precision, automatic derivatives, and
// packs of several numbers at once, whose comparisons give one answer per number.
#pragma once

#include <concepts>
#include <numbers>

namespace gonio::brdf {

/// Pi, to the precision of T or of double.
template <class T>
T pi() {
  if constexpr (std::floating_point<T>) {
    return std::numbers::pi_v<T>;
  } else {
    return T(std::numbers::pi);
  }
}

/// a < b; a mask for packs.
template <class T>
bool less(const T& a, const T& b) {
  return a < b;
}

/// True where both are.
inline bool both(bool a, bool b) { return a && b; }

/// `a` where the condition holds, else `b`. Both are computed: the one not taken may be anything,
/// NaN included.
template <class T>
T select(bool condition, const T& a, const T& b) {
  return condition ? a : b;
}

/// The larger of two; `a` if they cannot be compared.
template <class T>
T larger(const T& a, const T& b) {
  return select(less(a, b), b, a);
}

}  // namespace gonio::brdf
