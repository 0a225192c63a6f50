// LBNL's BSDF XML in a Klems basis.
#include "table/formats/klems.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "table/file_error.h"
#include "tests/real_data.h"
#include "tests/run_gonio.h"
#include "tests/small_tables.h"

namespace gonio::tests {
namespace {

using table::SampleTable;
using testing::ElementsAre;
using testing::HasSubstr;

std::string small_klems() {
  for (const SmallTable& small : small_tables()) {
    if (small.format == "klems") return small.bytes;
  }
  return {};
}

SampleTable read(const std::string& content) { return table::read_klems(content, "t.xml", {}); }

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

std::string refusal(const std::string& content) {
  try {
    read(content);
  } catch (const table::FileError& error) {
    return error.what();
  }
  return "accepted";
}

// The small file: a pole of 0 to 30 deg and a ring of 4 patches at 60 deg; value 10 exit +
// incident.

TEST(Klems, EqualPatchesAreMirrorDirections) {
  const SampleTable table = read(small_klems());
  ASSERT_EQ(table.size(), 25U);
  EXPECT_THAT(table.channels, ElementsAre("Visible"));
  for (std::size_t patch = 0; patch < 5; ++patch) {
    const std::size_t k = patch * 5 + patch;
    EXPECT_EQ(table.values[0][k], 10.0 * double(patch) + double(patch));
    EXPECT_NEAR(table.wi.x[k], -table.wo.x[k], 1e-15);
    EXPECT_NEAR(table.wi.y[k], -table.wo.y[k], 1e-15);
    EXPECT_EQ(table.wi.z[k], table.wo.z[k]);
  }
  // Exit patch 2 is at azimuth 90 deg, incident patch 1 is lit from azimuth 180 deg.
  const std::size_t k = 2 * 5 + 1;
  EXPECT_EQ(table.values[0][k], 21);
  EXPECT_NEAR(table.wo.y[k], std::sin(std::numbers::pi / 3), 1e-15);
  EXPECT_NEAR(table.wi.x[k], -std::sin(std::numbers::pi / 3), 1e-15);
}

TEST(Klems, RowsOfIncidentPatchesAreTransposed) {
  const SampleTable table = read(replaced(small_klems(), ">Columns<", ">Rows<"));
  EXPECT_EQ(table.values[0][2 * 5 + 1], 12);
}

TEST(Klems, WeightsAreProjectedSolidAnglesThatFillBothHemispheres) {
  const SampleTable table = read(small_klems());
  const double sum = std::accumulate(table.weight.begin(), table.weight.end(), 0.0);
  EXPECT_NEAR(sum, std::numbers::pi * std::numbers::pi, 1e-14);
}

TEST(Klems, AGridGivesThePatchThatADirectionIsIn) {
  const auto grid = table::read_klems_grid(small_klems(), "t.xml");
  double f_r = 0;
  const auto at = [&](double theta_i, double phi_i, double theta_o, double phi_o) {
    grid.f_r(brdf::direction_from_degrees(theta_i, phi_i),
             brdf::direction_from_degrees(theta_o, phi_o), {&f_r, 1});
    return f_r;
  };
  EXPECT_EQ(at(29, 77, 50, 130), 20);   // incident pole, exit patch at 90 deg
  EXPECT_EQ(at(45, 190, 80, -40), 11);  // light from 180: patch 1; exit at 0
  EXPECT_EQ(at(45, 190, 10, 0), 1);
  EXPECT_TRUE(std::isnan(at(45, 190, 90.5, 0)));
}

TEST(Klems, RefusesWhatIsNoMatrixOfAReflection) {
  const std::string good = small_klems();
  EXPECT_THAT(refusal(good.substr(0, good.size() / 2)), HasSubstr("no XML that can be read"));
  EXPECT_THAT(refusal(replaced(good, "Reflection Front", "Transmission Front")),
              HasSubstr("found no block of direction 'Reflection Front'"));
  EXPECT_THAT(refusal(replaced(good, ">Columns<", ">TensorTree4<")), HasSubstr("TensorTree4"));
  EXPECT_THAT(refusal(replaced(good, "<nPhis>4<", "<nPhis>5<")),
              HasSubstr("found 25 values, expected 36"));
  EXPECT_THAT(refusal(replaced(good, "<nPhis>4<", "<nPhis>1e9<")), HasSubstr("nPhis"));
  EXPECT_THAT(refusal(replaced(good, "<nPhis>4<", "<nPhis>-4<")), HasSubstr("nPhis"));
  EXPECT_THAT(refusal(replaced(good, "<LowerTheta>30<", "<LowerTheta>20<")), HasSubstr("overlaps"));
  EXPECT_THAT(refusal(replaced(good, "<UpperTheta>90<", "<UpperTheta>95<")), HasSubstr("0 to 90"));
  EXPECT_THAT(refusal(replaced(good, " 44", " nan")), HasSubstr("value 25: found 'nan"));
  EXPECT_THAT(refusal(replaced(good, " 44", " 44, 5")), HasSubstr("more than 25 values"));
  EXPECT_THAT(refusal(replaced(good, "<ColumnAngleBasis>small", "<ColumnAngleBasis>other")),
              HasSubstr("found the basis 'other'"));
}

TEST(Klems, ReadsTheWindowShadeAndItsReflectance) {
  GONIO_REAL_DATA_OR_SKIP(path, "klems/2011-SA1.xml");
  const SampleTable table = table::read(path);
  ASSERT_EQ(table.size(), 145U * 145U);
  EXPECT_THAT(table.channels, ElementsAre("Visible", "Solar"));
  EXPECT_EQ(table.name, "Satine 5500 5%, White Pearl");
  // The hemispherical reflectance of each incident patch: the sum over exits of lambda times value.
  // The patches of all exits have together pi, so that this shade, constant over exits, reflects pi
  // times its value.
  double lambda_of_incident = 0;
  double reflected = 0;
  for (std::size_t o = 0; o < 145; ++o) lambda_of_incident += table.weight[o * 145];
  for (std::size_t o = 0; o < 145; ++o) {
    reflected +=
        table.weight[o * 145] / lambda_of_incident * std::numbers::pi * table.values[0][o * 145];
  }
  EXPECT_NEAR(reflected, std::numbers::pi * table.values[0][0], 1e-6);
  EXPECT_GT(reflected, 0.1);
  EXPECT_LT(reflected, 1);
}

}  // namespace
}  // namespace gonio::tests
