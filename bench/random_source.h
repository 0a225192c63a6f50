// Random numbers for studies: the same ones on every machine, which the distributions of the
// standard library do not promise.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

namespace gonio::bench {

class RandomSource {
 public:
  /// The same seed and stream give the same numbers.
  RandomSource(std::uint64_t seed, std::uint64_t stream)
      : generator_(seed * 0x9E3779B97F4A7C15U + stream) {}

  /// Uniform over [0, 1), in steps of 2^-53.
  double unit() { return double(generator_() >> 11) * 0x1p-53; }
  /// Uniform over [lowest, highest).
  double uniform(double lowest, double highest) { return lowest + (highest - lowest) * unit(); }
  /// Every order of magnitude from `lowest` > 0 to `highest` is equally likely.
  double magnitude(double lowest, double highest) {
    return std::exp(uniform(std::log(lowest), std::log(highest)));
  }
  /// One of 0, 1, .. count - 1.
  std::size_t index(std::size_t count) { return std::size_t(generator_() % count); }
  bool coin() { return generator_() % 2 == 0; }
  std::uint64_t bits() { return generator_(); }

 private:
  std::mt19937_64 generator_;
};

}  // namespace gonio::bench
