// Sums over columns of whole packs, for functions declared GONIO_FOR_EACH_CPU.
#pragma once

#include <cstddef>

#include "brdf/pack.h"

namespace gonio::fit {

/// Of `count` numbers, a multiple of Pack::size. Four sums side by side, as an addition has to wait
/// for the one before.
inline double inner_product(const double* a, const double* b, std::size_t count) {
  using brdf::Pack;
  constexpr std::size_t step = 4 * Pack::size;
  Pack sums[4] = {Pack(0), Pack(0), Pack(0), Pack(0)};
  std::size_t i = 0;
  for (; i + step <= count; i += step) {
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t at = i + k * Pack::size;
      sums[k] += Pack::load(a + at) * Pack::load(b + at);
    }
  }
  for (; i < count; i += Pack::size) sums[0] += Pack::load(a + i) * Pack::load(b + i);
  return ((sums[0] + sums[1]) + (sums[2] + sums[3])).sum();
}

/// to += factor * from, elementwise.
inline void add_multiple(double* to, double factor, const double* from, std::size_t count) {
  using brdf::Pack;
  const Pack f(factor);
  for (std::size_t i = 0; i < count; i += Pack::size) {
    (Pack::load(to + i) + f * Pack::load(from + i)).store(to + i);
  }
}

/// to += factor * a * b, elementwise.
inline void add_product(double* to, double factor, const double* a, const double* b,
                        std::size_t count) {
  using brdf::Pack;
  const Pack f(factor);
  for (std::size_t i = 0; i < count; i += Pack::size) {
    (Pack::load(to + i) + f * Pack::load(a + i) * Pack::load(b + i)).store(to + i);
  }
}

}  // namespace gonio::fit
