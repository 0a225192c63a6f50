// Doubles in an image whose pixels have 32 bits.
//
// A number stands as FLOAT, cut off towards zero to 24 bits, so that every viewer shows it. What
// was cut off, the other 29 bits, stands in a UINT channel of the same name with ".tail". Numbers
// that FLOAT's exponents do not reach stand whole in two UINT channels, ".high" and ".low",
// besides.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace gonio::table {

inline constexpr std::uint64_t tail_mask = (std::uint64_t{1} << 29) - 1;

/// True for numbers that FLOAT and tail hold together: 0, a NaN, and what has FLOAT's exponents.
inline bool has_float_range(double value) {
  const double size = std::abs(value);
  return !(size > 0) || (size >= double{std::numeric_limits<float>::min()} &&
                         size <= double{std::numeric_limits<float>::max()});
}

/// The number cut off to 24 bits; beyond FLOAT's range the nearest end of it.
inline float head_of(double value) {
  if (std::isnan(value)) return std::numeric_limits<float>::quiet_NaN();
  if (std::abs(value) > double{std::numeric_limits<float>::max()}) {
    return static_cast<float>(std::copysign(double{std::numeric_limits<float>::max()}, value));
  }
  const auto bits = std::bit_cast<std::uint64_t>(value) & ~tail_mask;
  return static_cast<float>(std::bit_cast<double>(bits));
}

/// The nearest number of 24 bits; beyond FLOAT's range the nearest end of it.
inline float rounded(double value) {
  if (!has_float_range(value)) return head_of(value);
  return static_cast<float>(value);
}

inline std::uint32_t tail_of(double value) {
  if (std::isnan(value)) return 0;
  return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(value) & tail_mask);
}

/// The number of a head and a tail below 2^29; infinity has no tail.
inline double joined(float head, std::uint32_t tail) {
  if (!std::isfinite(head)) return double{head};
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(double{head}) | tail);
}

inline double whole_of(std::uint32_t high, std::uint32_t low) {
  const double value = std::bit_cast<double>(std::uint64_t{high} << 32 | low);
  return std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : value;
}

}  // namespace gonio::table
