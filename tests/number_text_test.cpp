// Numbers in text: the fast path for short decimals against the standard library, which rounds
// correctly, and what lies beyond the range of double.
#include "table/formats/number_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace gonio::tests {
namespace {

TEST(NumberText, RoundsEveryNumberLikeTheStandardLibrary) {
  std::mt19937_64 random(7);
  std::vector<std::string> texts{"0",
                                 "-0",
                                 "00012.5",
                                 "9007199254740993",
                                 "1e22",
                                 "1e-5",
                                 "0.1",
                                 ".5",
                                 "5.",
                                 "-.25",
                                 "1E3",
                                 "4e-324",
                                 "1e308",
                                 "123456789012345678",
                                 "0.1234567890123456789"};
  for (int i = 0; i < 200000; ++i) {
    const auto digits = std::to_string(random() >> (random() % 64));
    std::string text = random() % 2 == 0 ? "-" : "";
    const std::size_t point = random() % (digits.size() + 1);
    text += digits.substr(0, point);
    if (random() % 8 != 0) text += "." + digits.substr(point);
    if (text.empty() || text.back() == '-' || text == "." || text == "-.") continue;
    texts.push_back(text);
  }
  for (const std::string& text : texts) {
    double expected = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), expected);
    ASSERT_EQ(end.ptr, text.data() + text.size()) << text;
    // Behind the number stands what may follow it; the copy ends exactly there or goes on.
    for (const std::string behind : {"", ",", "\n", " ,123456789"}) {
      const std::string field = text + behind;
      const std::vector<char> exact(field.begin(), field.end());
      const char* at = exact.data();
      double value = 0;
      ASSERT_EQ(table::read_number(at, exact.data() + exact.size(), value),
                table::NumberText::number)
          << field;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(expected))
          << field;
      ASSERT_EQ(at, exact.data() + text.size()) << field;
    }
  }
}

TEST(NumberText, IsZeroWhereItIsTooSmallAndRefusedWhereItIsTooLarge) {
  const auto read = [](const std::string& text, double& value) {
    const char* at = text.data();
    return table::read_number(at, at + text.size(), value);
  };
  const std::string zeros(400, '0');
  for (const std::string& text :
       {std::string("1e-400"), std::string("-1e-99999999999"), "0." + zeros + "1"}) {
    double value = 1;
    EXPECT_EQ(read(text, value), table::NumberText::number) << text;
    EXPECT_EQ(value, 0) << text;
  }
  for (const std::string& text :
       {std::string("1e999"), std::string("-1E+99999999999"), "1" + zeros + ".5"}) {
    double value = 1;
    EXPECT_EQ(read(text, value), table::NumberText::too_large) << text;
  }
}

}  // namespace
}  // namespace gonio::tests
