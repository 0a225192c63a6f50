// Which known name a message suggests for a mistyped one.
#include "brdf/nearest_name.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gonio::tests {
namespace {

using brdf::nearest_name;

const std::vector<std::string>& term_names() {
  static const std::vector<std::string> names{"lambert",     "oren-nayar", "oren-nayar-full",
                                              "ward",        "ward-duer",  "ward-aniso",
                                              "blinn-phong", "phong"};
  return names;
}

TEST(NearestNameTest, FindsTheNameForEachKindOfSlip) {
  EXPECT_EQ(nearest_name("wrd", term_names()), "ward");                      // a letter missing
  EXPECT_EQ(nearest_name("waard", term_names()), "ward");                    // one too many
  EXPECT_EQ(nearest_name("werd", term_names()), "ward");                     // a wrong one
  EXPECT_EQ(nearest_name("wrad", term_names()), "ward");                     // two exchanged
  EXPECT_EQ(nearest_name("ward_duer", term_names()), "ward-duer");           // another habit
  EXPECT_EQ(nearest_name("orennayarful", term_names()), "oren-nayar-full");  // 3 of 12 letters
}

TEST(NearestNameTest, TakesCapitalsForSmallLetters) {
  EXPECT_EQ(nearest_name("Oren-Nayar", term_names()), "oren-nayar");
  EXPECT_EQ(nearest_name("LAMBERT", term_names()), "lambert");
}

TEST(NearestNameTest, PrefersTheNearerOfTwoNames) {
  EXPECT_EQ(nearest_name("ward-anis", term_names()), "ward-aniso");
  EXPECT_EQ(nearest_name("oren-nayr", term_names()), "oren-nayar");
}

TEST(NearestNameTest, PrefersTheEarlierOfTwoEquallyNearNames) {
  const std::vector<std::string> names{"alpha_x", "alpha_y"};
  EXPECT_EQ(nearest_name("alpha_z", names), "alpha_x");
}

// Exchanging neighbours is one edit; as two replacements it would be too far for four letters.
TEST(NearestNameTest, CountsTwoExchangedLettersAsOneSlip) {
  const std::vector<std::string> names{"card", "ward"};
  EXPECT_EQ(nearest_name("wadr", names), "ward");
  EXPECT_EQ(nearest_name("wdra", names), std::nullopt);
}

TEST(NearestNameTest, SuggestsNothingForANameThatResemblesNone) {
  EXPECT_EQ(nearest_name("cook-torrance", term_names()), std::nullopt);
  EXPECT_EQ(nearest_name("ggx", term_names()), std::nullopt);
  EXPECT_EQ(nearest_name("", term_names()), std::nullopt);
  EXPECT_EQ(nearest_name("ward", {}), std::nullopt);
}

// One letter is always one replacement away from any other.
TEST(NearestNameTest, SuggestsNothingThatSharesNoLetter) {
  const std::vector<std::string> names{"c", "s", "m", "t", "nu"};
  EXPECT_EQ(nearest_name("x", names), std::nullopt);
  EXPECT_EQ(nearest_name("S", names), "s");
  EXPECT_EQ(nearest_name("nuu", names), "nu");
}

}  // namespace
}  // namespace gonio::tests
