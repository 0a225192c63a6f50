// Pack: four doubles that are computed with at once.
//
// The terms' templated formulas take it in place of double and then evaluate four pairs of
// directions. Built on the vector types of GCC and Clang, so that the compiler picks the
// instructions; a function that loops over packs is declared GONIO_FOR_EACH_CPU and exists once
// per instruction set in the same binary.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "brdf/scalar.h"

// One copy for any x86-64 and one for those with AVX2 and FMA, chosen when the program starts, with
// everything that the function calls inlined. The sanitizers' run-time is not there so early.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && defined(__OPTIMIZE__)
#define GONIO_FOR_EACH_CPU [[gnu::target_clones("default", "arch=x86-64-v3"), gnu::flatten]]
#else
#define GONIO_FOR_EACH_CPU
#endif

namespace gonio::brdf {

class Pack {
 public:
  static constexpr std::size_t size = 4;
  // Aligned to 16 bytes, which is what Eigen gives the derivatives of a Jet; unaligned loads cost
  // nothing today.
  using Lanes [[gnu::vector_size(32), gnu::aligned(16)]] = double;
  using Bits [[gnu::vector_size(32), gnu::aligned(16)]] = std::int64_t;

  Pack() = default;
  Pack(double value) : lanes_{value, value, value, value} {}  // NOLINT: a number is a pack of it
  explicit Pack(const Lanes& lanes) : lanes_(lanes) {}

  static Pack load(const double* values) {
    Pack pack;
    std::memcpy(&pack.lanes_, values, sizeof pack.lanes_);
    return pack;
  }
  void store(double* values) const { std::memcpy(values, &lanes_, sizeof lanes_); }

  const Lanes& lanes() const { return lanes_; }
  double operator[](std::size_t lane) const { return lanes_[lane]; }
  double sum() const { return (lanes_[0] + lanes_[1]) + (lanes_[2] + lanes_[3]); }

  Pack operator-() const { return Pack(-lanes_); }
  Pack& operator+=(const Pack& b) { return *this = Pack(lanes_ + b.lanes_); }
  Pack& operator-=(const Pack& b) { return *this = Pack(lanes_ - b.lanes_); }
  Pack& operator*=(const Pack& b) { return *this = Pack(lanes_ * b.lanes_); }
  Pack& operator/=(const Pack& b) { return *this = Pack(lanes_ / b.lanes_); }
  friend Pack operator+(const Pack& a, const Pack& b) { return Pack(a.lanes_ + b.lanes_); }
  friend Pack operator-(const Pack& a, const Pack& b) { return Pack(a.lanes_ - b.lanes_); }
  friend Pack operator*(const Pack& a, const Pack& b) { return Pack(a.lanes_ * b.lanes_); }
  friend Pack operator/(const Pack& a, const Pack& b) { return Pack(a.lanes_ / b.lanes_); }

 private:
  Lanes lanes_;
};

/// The answer of a comparison: all bits of a lane, or none.
struct PackMask {
  Pack::Bits bits;
};

inline PackMask less(const Pack& a, const Pack& b) { return {a.lanes() < b.lanes()}; }
inline PackMask both(const PackMask& a, const PackMask& b) { return {a.bits & b.bits}; }
inline Pack select(const PackMask& mask, const Pack& a, const Pack& b) {
  return Pack(mask.bits ? a.lanes() : b.lanes());
}

namespace pack_detail {

/// 1.5 * 2^52: added to a number below 2^51 it leaves the nearest integer in the lowest bits.
inline constexpr double round_to_integer = 0x1.8p52;

inline Pack rounded(const Pack& x) {
  return Pack((x.lanes() + round_to_integer) - round_to_integer);
}

inline Pack::Bits bits_of(const Pack& x) {
  Pack::Bits bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

inline Pack with_bits(const Pack::Bits& bits) {
  Pack pack;
  std::memcpy(static_cast<void*>(&pack), &bits, sizeof bits);
  return pack;
}

/// 2^exponent for whole exponents from -1022 to 1023.
inline Pack power_of_two(const Pack& exponent) {
  return with_bits(bits_of(exponent + Pack(round_to_integer + 1023)) << 52);
}

/// The number that non-negative integers below 2^52 stand for.
inline Pack from_integers(const Pack::Bits& integers) {
  constexpr double two_to_52 = 0x1p52;
  return with_bits(integers | bits_of(Pack(two_to_52))) - Pack(two_to_52);
}

/// The integer that a whole number from 0 to below 2^51 stands for.
inline Pack::Bits to_integers(const Pack& whole) {
  constexpr double two_to_52 = 0x1p52;
  return bits_of(whole + Pack(two_to_52)) & std::int64_t(0x000fffffffffffff);
}

}  // namespace pack_detail

/// e^x to 2 units in the last place; 0 below -745.2, infinity above 709.8. Cody & Waite's (1980)
/// reduction to |r| <= ln(2)/2, then Taylor's series, whose remainder is 4e-18.
inline Pack exp(const Pack& x) {
  using pack_detail::power_of_two;
  using pack_detail::rounded;
  constexpr double log2_e = 0x1.71547652b82fep+0;
  constexpr double ln2_high = 0x1.62e42fee00000p-1;  // 32 bits: its multiples are exact
  constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  const Pack bounded = select(less(x, Pack(-746)), Pack(-746), select(less(Pack(710), x), 710, x));
  const Pack n = rounded(bounded * Pack(log2_e));
  const Pack r = (bounded - n * Pack(ln2_high)) - n * Pack(ln2_low);
  Pack series(1.0 / 6227020800.0);  // 1/13!
  series = series * r + Pack(1.0 / 479001600.0);
  series = series * r + Pack(1.0 / 39916800.0);
  series = series * r + Pack(1.0 / 3628800.0);
  series = series * r + Pack(1.0 / 362880.0);
  series = series * r + Pack(1.0 / 40320.0);
  series = series * r + Pack(1.0 / 5040.0);
  series = series * r + Pack(1.0 / 720.0);
  series = series * r + Pack(1.0 / 120.0);
  series = series * r + Pack(1.0 / 24.0);
  series = series * r + Pack(1.0 / 6.0);
  series = series * r + Pack(0.5);
  series = series * r * r + r + Pack(1);
  // In two steps: 2^n alone may be no normal number.
  const Pack half = rounded(n * Pack(0.5));
  return series * power_of_two(half) * power_of_two(n - half);
}

/// The natural logarithm of normal positive numbers, to 2 units in the last place: x = m 2^e with m
/// about 1, and ln m = 2 atanh((m - 1) / (m + 1)) by its series.
inline Pack log(const Pack& x) {
  using pack_detail::bits_of;
  using pack_detail::from_integers;
  using pack_detail::with_bits;
  constexpr double ln2_high = 0x1.62e42fee00000p-1;
  constexpr double ln2_low = 0x1.a39ef35793c76p-33;
  const Pack::Bits bits = bits_of(x);
  const Pack exponent = from_integers((bits >> 52) & std::int64_t(0x7ff)) - Pack(1023);
  const Pack mantissa = with_bits((bits & std::int64_t(0x000fffffffffffff)) | bits_of(Pack(1)));
  const PackMask upper = less(Pack(1.4142135623730951), mantissa);
  const Pack m = select(upper, mantissa * Pack(0.5), mantissa);
  const Pack e = select(upper, exponent + Pack(1), exponent);
  const Pack f = m - Pack(1);
  const Pack s = f / (Pack(2) + f);
  const Pack z = s * s;
  Pack series(2.0 / 23);
  series = series * z + Pack(2.0 / 21);
  series = series * z + Pack(2.0 / 19);
  series = series * z + Pack(2.0 / 17);
  series = series * z + Pack(2.0 / 15);
  series = series * z + Pack(2.0 / 13);
  series = series * z + Pack(2.0 / 11);
  series = series * z + Pack(2.0 / 9);
  series = series * z + Pack(2.0 / 7);
  series = series * z + Pack(2.0 / 5);
  series = series * z + Pack(2.0 / 3);
  // ln m = 2s + s z series = f - s (f - z series), where f is exact.
  return e * Pack(ln2_high) + (f - (s * (f - z * series) - e * Pack(ln2_low)));
}

/// ln(1 + x) for finite x above -1, to 3 units in the last place: the logarithm of the rounded sum,
/// put right by what the rounding took away.
inline Pack log1p(const Pack& x) {
  const Pack sum = Pack(1) + x;
  return log(sum) + (x - (sum - Pack(1))) / sum;
}

/// The cube root of numbers from 0 to 1e307, to 2 units in the last place; 0 below 1e-300. A third
/// of the exponent for a start (4 % off), then three of Halley's steps, each cubing the error.
inline Pack cbrt(const Pack& x) {
  using pack_detail::bits_of;
  using pack_detail::from_integers;
  using pack_detail::rounded;
  using pack_detail::to_integers;
  using pack_detail::with_bits;
  // Bits 20 to 63 as a number: 2^32 stands for a factor of 2.
  constexpr double start = 0x1p32 * (2.0 / 3 * 1023 - 0.0330624);
  const Pack high = from_integers(bits_of(x) >> 20);
  Pack y = with_bits(to_integers(rounded(high * Pack(1.0 / 3) + Pack(start))) << 20);
  for (int step = 0; step < 3; ++step) {
    const Pack cube = y * y * y;
    y = y - y * ((cube - x) / (cube + cube + x));
  }
  return select(less(x, Pack(1e-300)), 0, y);
}

namespace pack_detail {

/// Lane by lane, for functions that no inner loop waits for.
template <class F>
Pack each(const Pack& x, const F& function) {
  return Pack(Pack::Lanes{function(x[0]), function(x[1]), function(x[2]), function(x[3])});
}
template <class F>
Pack each(const Pack& x, const Pack& y, const F& function) {
  return Pack(Pack::Lanes{function(x[0], y[0]), function(x[1], y[1]), function(x[2], y[2]),
                          function(x[3], y[3])});
}

}  // namespace pack_detail

inline Pack sqrt(const Pack& x) {
  return pack_detail::each(x, [](double v) { return std::sqrt(v); });
}
inline Pack abs(const Pack& x) {
  return pack_detail::with_bits(pack_detail::bits_of(x) & std::int64_t(0x7fffffffffffffff));
}
inline Pack copysign(const Pack& size, const Pack& sign) {
  return pack_detail::with_bits(
      (pack_detail::bits_of(sign) & std::numeric_limits<std::int64_t>::min()) |
      pack_detail::bits_of(abs(size)));
}
inline Pack sin(const Pack& x) {
  return pack_detail::each(x, [](double v) { return std::sin(v); });
}
inline Pack cos(const Pack& x) {
  return pack_detail::each(x, [](double v) { return std::cos(v); });
}
inline Pack atan2(const Pack& y, const Pack& x) {
  return pack_detail::each(y, x, [](double a, double b) { return std::atan2(a, b); });
}

}  // namespace gonio::brdf

template <>
struct std::numeric_limits<gonio::brdf::Pack> : std::numeric_limits<double> {
  static gonio::brdf::Pack max() noexcept { return {std::numeric_limits<double>::max()}; }
};
