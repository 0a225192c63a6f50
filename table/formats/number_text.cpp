#include "table/formats/number_text.h"

#include <algorithm>

namespace gonio::table {

bool is_underflow(std::string_view text) {
  const std::size_t e = std::min(text.find_first_of("eE"), text.size());
  if (e + 1 < text.size()) {
    long exponent = 0;
    const char* digits = text.data() + e + 1;
    if (*digits == '+') ++digits;
    const auto [behind, error] = std::from_chars(digits, text.data() + text.size(), exponent);
    // Fields have no millions of digits: a written exponent of three digits decides by its sign.
    if (error != std::errc() || exponent <= -300 || exponent >= 300) return text[e + 1] == '-';
  }
  // A long row of digits: too large if any of those before the point is not zero.
  const std::string_view whole = text.substr(0, std::min(text.find('.'), e));
  return whole.find_first_of("123456789") == std::string_view::npos;
}

}  // namespace gonio::table
