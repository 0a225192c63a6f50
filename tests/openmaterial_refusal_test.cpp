// What is no OpenMATERIAL 3D table, and where it says so.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "table/file_error.h"
#include "table/formats/openmaterial.h"
#include "tests/openmaterial_text.h"

namespace gonio::tests {
namespace {

using table::SampleTable;
using testing::AllOf;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

std::string refusal(const std::string& content) {
  EXPECT_ANY_THROW(table::read_openmaterial_grid(content, "t.xompt"));
  try {
    read_text(content);
  } catch (const table::FileError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("t.xompt: "));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "accepted";
}

TEST(OpenMaterialTable, IsToldByItsContent) {
  EXPECT_TRUE(table::is_openmaterial(document("5e-7", "[5e-7, 0, 0, 0, 1]")));
  EXPECT_TRUE(table::is_openmaterial("\xEF\xBB\xBF {\"brdf\": {\"lookupTable\": []}}"));
  EXPECT_FALSE(table::is_openmaterial(""));
  EXPECT_FALSE(table::is_openmaterial("[\"brdf\", \"lookupTable\"]"));
  EXPECT_FALSE(table::is_openmaterial(R"({"metadata": {"openMaterial3dVersion": "1.0.0"}})"));
  EXPECT_FALSE(table::is_openmaterial(
      R"({"format": "gonio-material", "name": "brdf", "brdf": 1, "lookupTable": 2})"));
}

TEST(OpenMaterialTable, RefusesRowsThatCannotBeUsed) {
  const auto second = [](const std::string& row) {
    return refusal(document("5e-7", "[5e-7, 0, 0, 0, 1], " + row));
  };
  EXPECT_THAT(second("[5e-7, 0, 0.1, 0]"),
              AllOf(HasSubstr("/brdf/lookupTable/1: found 4 numbers, expected 5"),
                    HasSubstr("complete the row")));
  EXPECT_THAT(second("[5e-7, 0, 0.1, 0, 1, 2]"), HasSubstr("/1: found 6 numbers, expected 5"));
  EXPECT_THAT(second("[]"), HasSubstr("/1: found 0 numbers"));
  EXPECT_THAT(second("[5e-7, 0, \"0.1\", 0, 1]"), HasSubstr("/1: found a text as number 3"));
  EXPECT_THAT(second("[5e-7, 0, 0.1, true, 1]"), HasSubstr("/1: found true as number 4"));
  EXPECT_THAT(second("[5e-7, [0], 0.1, 0, 1]"), HasSubstr("/1: found an array as number 2"));
  EXPECT_THAT(second("{}"), HasSubstr("/1: found an object, expected a row of 5"));
  EXPECT_THAT(second("7"), HasSubstr("/1: found 7, expected a row of 5"));
  EXPECT_THAT(second("[5e-7, 1.58, 0.1, 0, 1]"), HasSubstr("/1: found the incident zenith 1.58"));
  EXPECT_THAT(second("[5e-7, 0.1, -0.1, 0, 1]"), HasSubstr("/1: found the exit zenith -0.1"));
  EXPECT_THAT(second("[5e-7, 0.1, 0.1, 6.3, 1]"), HasSubstr("/1: found the exit azimuth 6.3"));
  EXPECT_THAT(second("[5e-7, null, 0.1, 0, 1]"), HasSubstr("/1: the incident zenith is null"));
  EXPECT_THAT(second("[5e-7, 0, null, 0, 1]"), HasSubstr("/1: the exit zenith is null"));
  EXPECT_THAT(second("[5e-7, 0.1, 0.1, null, 1]"), HasSubstr("/1: the exit azimuth is null"));
  EXPECT_THAT(second("[550, 0, 0.1, 0, 1]"), HasSubstr("/1: found the wavelength 550, expected"));
  EXPECT_THAT(second("[5.00001e-7, 0, 0.1, 0, 1]"),
              HasSubstr("/1: found the wavelength 5.00001e-07, expected one of /brdf/wavelengths"));
  EXPECT_THAT(second("[null, 0, 0.1, 0, 1]"), HasSubstr("/1: found the wavelength null"));
  EXPECT_THAT(second("[5e-7, 0, 0.1, 0, 1], [5e-7, -0.0, 0, 0, 3]"),
              HasSubstr("/2: its wavelength and angles are those of row 0"));
  EXPECT_THAT(refusal(document("5e-7", "[null, 0, 0, 0, 1], [5e-7, 0, 0.1, 0, 1]")),
              HasSubstr("/1: found the wavelength 5e-07, expected null"));
}

TEST(OpenMaterialTable, RefusesWhatIsNoSuchDocument) {
  EXPECT_THAT(refusal(document("5e-7, 6e-7, 5.0000001e-7", "[5e-7, 0, 0, 0, 1]")),
              HasSubstr("/brdf/wavelengths/2: found 5.0000001e-07, which stands at 0 already"));
  EXPECT_THAT(refusal(document("5e-7, null", "[5e-7, 0, 0, 0, 1]")),
              HasSubstr("/brdf/wavelengths/1: found null, expected a wavelength in metres"));
  EXPECT_THAT(refusal(document("550", "[5e-7, 0, 0, 0, 1]")), HasSubstr("found 550, expected"));
  EXPECT_THAT(refusal(document("5e-7", "")), HasSubstr("/brdf/lookupTable: found no row"));
  const std::string table = R"("lookupTable": [[5e-7, 0, 0, 0, 1]])";
  const std::string list = R"("wavelengths": [5e-7])";
  const auto brdf = [](const std::string& members) { return "{\"brdf\": {" + members + "}}"; };
  EXPECT_THAT(refusal(brdf(table)), HasSubstr("/brdf/wavelengths: missing"));
  EXPECT_THAT(refusal(brdf(list)), HasSubstr("/brdf/lookupTable: missing"));
  EXPECT_THAT(refusal(brdf(table + "," + list + "," + table)),
              HasSubstr("/brdf/lookupTable: stands twice"));
  EXPECT_THAT(refusal(brdf(list + "," + table + "," + list)),
              HasSubstr("/brdf/wavelengths: stands twice"));
  EXPECT_THAT(refusal("{\"brdf\": {" + list + "}, \"brdf\": {" + table + "}}"),
              HasSubstr("/brdf: stands twice"));
  EXPECT_THAT(refusal(brdf(list + R"(, "lookupTable": {})")),
              HasSubstr("found an object, expected"));
  EXPECT_THAT(refusal(R"({"brdf": [1]})"), HasSubstr("/brdf: found an array, expected an object"));
  EXPECT_THAT(refusal("[1]"), HasSubstr("the document: found an array"));
}

TEST(OpenMaterialTable, SaysWhereTheTextIsNoJson) {
  EXPECT_THAT(refusal("{\"brdf\":\n {\"wavelengths\": [1e-7,, 2]}}"),
              HasSubstr("line 2, column 24: the text is no JSON"));
  EXPECT_THAT(refusal(document("5e-7", "[5e-7, 0, 0, 0, 1e999]")),
              HasSubstr("found a number that is too large for a double"));
  EXPECT_THAT(refusal(document("5e-7", "[5e-7, 0, 0, 0, NaN]")), HasSubstr("is no JSON"));
  const std::string whole = document("5e-7", "[5e-7, 0, 0, 0, 1]");
  EXPECT_THAT(refusal(whole + "x"), HasSubstr("is no JSON"));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ASSERT_NE(refusal(whole.substr(0, size)), "accepted") << size;
  }
}

TEST(OpenMaterialTable, DeepNestingIsNoRecursion) {
  const std::string deep(3'000'000, '[');
  EXPECT_THAT(refusal(deep), HasSubstr("the document: found an array"));
  EXPECT_THAT(refusal("{\"a\": " + deep), HasSubstr("is no JSON"));
  EXPECT_THAT(refusal(document(deep, "")), HasSubstr("/brdf/wavelengths/0: found an array"));
  const std::string closed = deep + std::string(deep.size(), ']');
  EXPECT_EQ(read_text("{\"a\": " + closed + ", " + document("5e-7", "[5e-7, 0, 0, 0, 1]").substr(1))
                .size(),
            1U);
}

TEST(OpenMaterialTable, WavelengthsWithDirectionsOfTheirOwnMayBeTooMany) {
  std::string wavelengths;
  std::string rows;
  for (int i = 0; i < 3000; ++i) {
    wavelengths += fmt::format("{}{}", i == 0 ? "" : ",", 1e-7 * (1 + i));
    rows += fmt::format("{}[{}, 0, {}, 0, 1]", i == 0 ? "" : ",", 1e-7 * (1 + i), 1e-4 * i);
  }
  EXPECT_THAT(refusal(document(wavelengths, rows)), HasSubstr("split the file by wavelengths"));
}

TEST(OpenMaterialTable, MutilatedFilesAreReadOrRefused) {
  const std::string whole =
      document("5e-7, 6e-7", trilinear_rows("5e-7", 2, pi) + "," + trilinear_rows("6e-7", 2, pi));
  std::mt19937 random(7);
  const auto below = [&](std::size_t count) { return static_cast<std::size_t>(random()) % count; };
  int refused = 0;
  for (int way = 0; way < 500; ++way) {
    std::string bytes = whole;
    if (way % 3 == 0) bytes.resize(1 + below(bytes.size() - 1));
    if (way % 3 == 1) {
      for (int k = 0; k < 4; ++k) bytes[below(bytes.size())] = static_cast<char>(random());
    }
    if (way % 3 == 2) {
      // A number grows, or one character becomes another of the table's.
      const std::size_t place = below(bytes.size());
      if (way % 2 == 0) bytes.insert(place, 1 + below(300), '9');
      if (way % 2 == 1) bytes[place] = "[],0e-.n"[below(8)];
    }
    try {
      const SampleTable t = read_text(bytes);
      table::read_openmaterial_grid(bytes, "t.xompt");
      ASSERT_GT(t.size(), 0U);
      for (const auto& values : t.values) {
        for (const double value : values) ASSERT_FALSE(std::isinf(value));
      }
      for (const double weight : t.weight) ASSERT_TRUE(std::isfinite(weight) && weight >= 0);
    } catch (const table::FileError& error) {
      ++refused;
      ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(refused, 250);
  EXPECT_LT(refused, 500);
}

}  // namespace
}  // namespace gonio::tests
