// A number in a field of a text table, whatever the locale.
#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <system_error>

#include "table/formats/text_lines.h"

namespace gonio::table {

enum class NumberText : std::uint8_t { number, empty, text, not_finite, too_large };

inline const char* skip_blanks(const char* at, const char* end) {
  while (at != end && is_blank(*at)) ++at;
  return at;
}

/// True if the decimal number `text`, which lies beyond the range of double, is too small for it
/// and not too large.
bool is_underflow(std::string_view text);

namespace number_text_detail {

/// 10^k, exact in double for these k.
inline constexpr std::array<double, 19> power_of_ten{1,    1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                                     1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                                     1e14, 1e15, 1e16, 1e17, 1e18};
inline constexpr std::array<std::uint64_t, 9> whole_power_of_ten{
    1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};

/// Appends the run of digits at `at` to `digits`, one by one.
inline const char* append_few_digits(const char* at, const char* end, std::uint64_t& digits) {
  while (at != end && *at >= '0' && *at <= '9') {
    digits = digits * 10 + static_cast<std::uint64_t>(*at++ - '0');
  }
  return at;
}

/// The same, eight characters at a time while there are as many: in a long run a branch for each
/// digit costs more than all the arithmetic.
inline const char* append_many_digits(const char* at, const char* end, std::uint64_t& digits) {
  if constexpr (std::endian::native == std::endian::little) {
    while (end - at >= 8) {
      std::uint64_t text = 0;
      std::memcpy(&text, at, sizeof text);
      const std::uint64_t value = text - 0x3030303030303030;
      // The highest bit of the lowest byte that is no digit is set in one of the two.
      const std::uint64_t others = (value | (text + 0x4646464646464646)) & 0x8080808080808080;
      const int count = std::countr_zero(others) / 8;
      if (count == 0) return at;
      // Leading zeros in front of the digits; the first one is the lowest byte. Then neighbours
      // are joined to pairs, to fours, to all eight.
      const std::uint64_t single = value << (64 - 8 * count);
      const std::uint64_t pairs = (single * 10 + (single >> 8)) & 0x00FF00FF00FF00FF;
      const std::uint64_t fours = (pairs * 100 + (pairs >> 16)) & 0x0000FFFF0000FFFF;
      const std::uint64_t joined = (fours * 10000 + (fours >> 32)) & 0x00000000FFFFFFFF;
      digits = digits * whole_power_of_ten[static_cast<std::size_t>(count)] + joined;
      at += count;
      if (count < 8) return at;
    }
  }
  return append_few_digits(at, end, digits);
}

/// Reads a decimal without exponent and with digits that double holds exactly, as most fields
/// are: then digits / 10^k is the correctly rounded value (Clinger 1990), found several times
/// faster than by std::from_chars. Returns nullptr where it is none.
inline const char* read_short_decimal(const char* at, const char* end, double& value) {
  constexpr std::uint64_t largest_exact = std::uint64_t{1} << 53;
  const bool is_negative = at != end && *at == '-';
  if (is_negative) ++at;
  const char* const start = at;
  std::uint64_t digits = 0;
  at = append_few_digits(at, end, digits);
  std::ptrdiff_t count = at - start;
  std::ptrdiff_t decimals = 0;
  if (at != end && *at == '.') {
    const char* const fraction = ++at;
    at = append_many_digits(at, end, digits);
    decimals = at - fraction;
    count += decimals;
  }
  // 18 digits cannot have overflowed; a letter may begin an exponent, "inf" or "nan".
  if (count == 0 || count > 18 || digits > largest_exact) return nullptr;
  if (at != end && (*at | 0x20) >= 'a' && (*at | 0x20) <= 'z') return nullptr;
  const double magnitude =
      static_cast<double>(digits) / power_of_ten[static_cast<std::size_t>(decimals)];
  value = is_negative ? -magnitude : magnitude;
  return at;
}

}  // namespace number_text_detail

/// Reads the number at `at`, which stands behind the field's leading blanks, and moves `at`
/// behind it. A leading '+' is accepted; a number too small for double is 0.
inline NumberText read_number(const char*& at, const char* end, double& value) {
  if (at == end || *at == ',' || *at == ';' || *at == '\n') return NumberText::empty;
  const char* start = at;
  if (*start == '+' && end - start > 1 && start[1] != '-') ++start;
  if (const char* behind = number_text_detail::read_short_decimal(start, end, value)) {
    at = behind;
    return NumberText::number;
  }
  const auto [behind, error] = std::from_chars(start, end, value);
  if (error == std::errc::invalid_argument) return NumberText::text;
  at = behind;
  if (error == std::errc::result_out_of_range) {
    if (!is_underflow({start, behind})) return NumberText::too_large;
    value = 0;
  }
  return std::isfinite(value) ? NumberText::number : NumberText::not_finite;
}

}  // namespace gonio::table
