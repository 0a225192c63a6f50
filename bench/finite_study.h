// Does any evaluation give NaN, infinity or a negative value? Random inputs by the million, half of
// them at extremes where numbers run out of range: denormal cosines, the horizon itself and below
// it, half vectors at the pole, parameters on their bounds and next to them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gonio::bench {

struct FiniteSettings {
  /// Of each term in each precision.
  std::uint64_t evaluations = 100'000;
  std::uint64_t seed = 1;
  /// 0: as many as the machine has. The results do not depend on it.
  int threads = 0;
};

struct FiniteCount {
  std::uint64_t evaluations = 0;
  /// Evaluations with a NaN, an infinity or a negative number among the basis functions, the
  /// coefficients or f_r.
  std::uint64_t unsound = 0;
  /// How many of the evaluations were not 0: a check of the draws.
  std::uint64_t lit = 0;
  /// The first unsound input in the order of the draws; empty if there is none.
  std::string first;
};

struct ModelFiniteness {
  std::string name;
  FiniteCount in_double, in_float;
};

/// One entry per term of brdf/terms.h, those with a free frame too.
std::vector<ModelFiniteness> count_unsound(const FiniteSettings& settings);

}  // namespace gonio::bench
