// ASAM OpenMATERIAL 3D tables: samples, weights, and what lies between them.
#include "table/formats/openmaterial.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "tests/openmaterial_text.h"
#include "tests/real_data.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using table::GriddedTable;
using table::MaskReason;
using table::SampleTable;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double pi = std::numbers::pi;

// Samples ------------------------------------------------------------------------------------

TEST(OpenMaterialTable, WavelengthsBecomeChannelsOfSharedDirections) {
  const SampleTable t =
      read_text(document("5.5e-07, 9.05e-07",
                         "[5.5e-7, 0.5, 0.25, 3.0, 0.1], [5.5e-7, 0.5, 0.5, 1.0, 2],"
                         "[9.05e-7, 0.5, 0.5, 1.0, 3], [9.05e-7, 0, 0.1, 2, 4]"));
  EXPECT_EQ(t.name, "small");
  EXPECT_THAT(t.channels, ElementsAre("550nm", "905nm"));
  ASSERT_EQ(t.size(), 3U);
  EXPECT_EQ(t.values[0][0], 0.1);
  EXPECT_EQ(t.values[0][1], 2);
  EXPECT_TRUE(std::isnan(t.values[0][2]));
  EXPECT_TRUE(std::isnan(t.values[1][0]));
  EXPECT_EQ(t.values[1][1], 3);
  EXPECT_EQ(t.values[1][2], 4);
  EXPECT_THAT(t.mask, Each(MaskReason::none));
  EXPECT_EQ(t.provenance.format, "OpenMATERIAL 3D");
  EXPECT_EQ(t.provenance.path, "t.xompt");
}

TEST(OpenMaterialTable, AzimuthZeroIsTowardsTheLight) {
  const SampleTable t = read_text(document("5.5e-7",
                                           "[5.5e-7, 0.5, 0.5, 0, 1], [5.5e-7, 0.5, 0.5, "
                                           "3.141592653589793, 2], [5.5e-7, 0.5, 0.5, 4, 3]"));
  EXPECT_NEAR(t.wo.x[0], t.wi.x[0], 1e-15);  // the same direction
  EXPECT_NEAR(t.wo.x[1], -t.wi.x[1], 1e-15);
  EXPECT_NEAR(t.wi.x[0], std::sin(0.5), 1e-15);
  EXPECT_EQ(t.wi.y[0], 0);
  EXPECT_NEAR(t.wo.y[2], std::sin(0.5) * std::sin(4.0), 1e-15);
  EXPECT_NEAR(t.wo.z[2], std::cos(0.5), 1e-15);
  EXPECT_THAT(t.notes, testing::Contains(HasSubstr("azimuth 0 is taken as towards the light")));
}

TEST(OpenMaterialTable, WavelengthsOfRowsMayBeRounded) {
  const SampleTable t = read_text(
      document("3.9e-07, 4.0000001e-07", "[3.9000001e-07, 0, 0, 0, 1], [4e-07, 0, 0, 0, 2]"));
  EXPECT_THAT(t.channels, ElementsAre("390nm", "400.00001nm"));
  EXPECT_EQ(t.values[1][0], 2);
}

TEST(OpenMaterialTable, ChannelsStandInTheOrderOfTheListAndThoseWithoutRowsAreDropped) {
  const SampleTable t =
      read_text(document("6e-7, 7e-7, 5e-7", "[5e-7, 0, 0, 0, 1], [6e-7, 0, 0, 0, 2]"));
  EXPECT_THAT(t.channels, ElementsAre("600nm", "500nm"));
  EXPECT_THAT(t.values, ElementsAre(ElementsAre(2), ElementsAre(1)));
  EXPECT_THAT(t.notes, ElementsAre(HasSubstr("1 of the wavelengths")));
}

TEST(OpenMaterialTable, NullIsAnAxisThatDoesNotMatterOrAHole) {
  const SampleTable t =
      read_text(document("", "[null, 0.5, 0, null, 1], [null, 0.5, 0.5, 1, null]"));
  EXPECT_THAT(t.channels, ElementsAre("brdf"));
  EXPECT_EQ(t.values[0][0], 1);
  EXPECT_THAT(t.mask, ElementsAre(MaskReason::none, MaskReason::hole));
  EXPECT_THAT(t.notes, testing::Contains(HasSubstr("the wavelength is null")));
}

TEST(OpenMaterialTable, TheLargestZenithOfTheStandardIsTheHorizon) {
  const SampleTable t =
      read_text(document("5e-7",
                         "[5e-7, 1.570796, 0, 0, 1], [5e-7, 0.1, 1.5707963267948966, 0, 1], "
                         "[5e-7, 0.1, 1.570795, 0, 1], [5e-7, 0.1, 1.57079633, 0, 1]"));
  EXPECT_THAT(t.mask, ElementsAre(MaskReason::horizon, MaskReason::horizon, MaskReason::none,
                                  MaskReason::horizon));
}

TEST(OpenMaterialTable, NegativeValuesAreDataAndSaidToBeThere) {
  const SampleTable t = read_text(document("5e-7", "[5e-7, 0.1, 0, 0, -0.25]"));
  EXPECT_EQ(t.values[0][0], -0.25);
  EXPECT_THAT(t.notes, ElementsAre(HasSubstr("1 values are negative")));
}

TEST(OpenMaterialTable, MembersOfNoUseDoNoHarm) {
  const SampleTable t = read_text(
      R"({"$schema": "x", "other": {"brdf": 5, "lookupTable": [[1]]}, "list": [[], {"a": null}],)"
      R"("brdf": {"receiverSolidAngles": [{"wavelength": 5e-7, "solidAngle": 1e-4}],)"
      R"("lookupTable": [[5e-7, 0, 0, 0, 1]], "wavelengths": [5e-7]}, "metadata": 7})");
  EXPECT_EQ(t.size(), 1U);
  EXPECT_EQ(t.name, "");
}

// Weights ------------------------------------------------------------------------------------

TEST(OpenMaterialTable, WeightsOfAGridFillBothHemispheres) {
  std::string rows;
  constexpr int steps = 12;
  for (int i = 0; i < steps; ++i) {
    for (int o = 0; o < steps; ++o) {
      for (int k = 0; k < (o == 0 ? 1 : 8); ++k) {
        rows += fmt::format("{}[5e-7, {}, {}, {}, {}]", rows.empty() ? "" : ",",
                            (i + 0.5) * pi / 2 / steps, o * pi / 2 / steps, k * pi / 4, 1);
      }
    }
  }
  const SampleTable t = read_text(document("5e-7", rows));
  ASSERT_EQ(t.weight.size(), t.size());
  // Of the light a solid angle per azimuth, 1; of the viewer 2 pi, but for the outermost ring,
  // which ends half a step beyond its node.
  const double largest = (steps - 0.5) * pi / 2 / steps;
  EXPECT_NEAR(std::accumulate(t.weight.begin(), t.weight.end(), 0.0),
              2 * pi * (1 - std::cos(largest)), 1e-12);
  EXPECT_GT(t.weight.front(), 0);  // at the pole
}

TEST(OpenMaterialTable, OneSidedGridsWeighAsHalfOfTwoSidedOnes) {
  const auto weights = [](int azimuths, double last) {
    return read_text(document("5e-7", trilinear_rows("5e-7", azimuths, last))).weight;
  };
  const std::vector<double> half = weights(4, pi);
  const std::vector<double> whole = weights(8, 2 * pi);
  ASSERT_EQ(half.size(), 3U * 4 * 5);
  for (std::size_t ring = 0; ring < 12; ++ring) {
    for (std::size_t k = 0; k <= 4; ++k) {
      const double share = k == 4 ? 0.5 : 1;  // pi counts for both sides
      ASSERT_NEAR(half[5 * ring + k], whole[9 * ring + k] * share, 1e-12) << ring << " " << k;
    }
  }
}

TEST(OpenMaterialTable, ASingleExitDirectionHasTheWeightOfItsLight) {
  const SampleTable t = read_text(
      document("5e-7", "[5e-7, 0.2, 0, 0, 1], [5e-7, 0.4, 0, 0, 1], [5e-7, 0.8, 0, 0, 1]"));
  ASSERT_EQ(t.weight.size(), 3U);
  EXPECT_NEAR(t.weight[0], std::cos(0.1) - std::cos(0.3), 1e-15);
  EXPECT_NEAR(t.weight[1], std::cos(0.3) - std::cos(0.6), 1e-15);
  EXPECT_NEAR(t.weight[2], std::cos(0.6) - std::cos(1.0), 1e-15);
}

TEST(OpenMaterialTable, ScatteredDirectionsHaveNoWeights) {
  const SampleTable t =
      read_text(document("5e-7",
                         "[5e-7, 0.2, 0.1, 0.5, 1], [5e-7, 0.2, 0.2, 2.5, 1], [5e-7, 0.2, 0.7, "
                         "1.5, 1]"));
  EXPECT_THAT(t.weight, IsEmpty());
  EXPECT_THAT(t.notes, testing::Contains(HasSubstr("form no grid")));
}

// Between the rows ---------------------------------------------------------------------------

double at(const GriddedTable& grid, double theta_i, double theta_o, double phi,
          double phi_i = 0.7) {
  double f_r = -1;
  grid.f_r(brdf::direction_from_radians(theta_i, phi_i),
           brdf::direction_from_radians(theta_o, phi_i + phi), {&f_r, 1});
  return f_r;
}

TEST(OpenMaterialGrid, IsLinearInEachAngleAndMirroredBeyondPi) {
  const auto grid =
      table::read_openmaterial_grid(document("5e-7", trilinear_rows("5e-7", 6, pi)), "t.xompt");
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 200; ++i) {
    const double theta_i = 1e-3 + 1.19 * unit(random);
    const double theta_o = 1e-3 + 1.49 * unit(random);
    const double phi = pi * unit(random);
    const double expected = trilinear(theta_i, theta_o, phi);
    ASSERT_NEAR(at(grid, theta_i, theta_o, phi), expected, 1e-11 * expected);
    ASSERT_NEAR(at(grid, theta_i, theta_o, -phi), expected, 1e-11 * expected);
  }
}

TEST(OpenMaterialGrid, ACircleGoesOnBehindItsLastAzimuth) {
  std::string rows;
  const auto value = [](int k) { return k % 4 == 3 ? 5.0 : k % 4; };
  for (int k = 0; k < 4; ++k) {
    rows += fmt::format("{}[5e-7, 0.5, 0.5, {}, {}]", k == 0 ? "" : ",", k * pi / 2, value(k));
  }
  const auto grid = table::read_openmaterial_grid(document("5e-7", rows), "t.xompt");
  EXPECT_NEAR(at(grid, 0.5, 0.5, 1.25 * pi / 2), 1.25, 1e-12);
  EXPECT_NEAR(at(grid, 0.5, 0.5, 2.5 * pi / 2), 3.5, 1e-12);
  EXPECT_NEAR(at(grid, 0.5, 0.5, 3.75 * pi / 2), 1.25, 1e-12);  // between 5 and 0
}

TEST(OpenMaterialGrid, IsNaNBeyondItsAngles) {
  const auto grid = table::read_openmaterial_grid(
      document("5e-7",
               "[5e-7, 0.5, 0.3, 1, 1], [5e-7, 0.5, 0.3, 2, 1], [5e-7, 0.5, 0.6, 1, 1], "
               "[5e-7, 0.5, 0.6, 2, 1], [5e-7, 0.7, 0.6, 1, 1], [5e-7, 0.7, 0.6, 2, null]"),
      "t.xompt");
  EXPECT_NEAR(at(grid, 0.5, 0.45, 1.5), 1, 1e-12);
  EXPECT_NEAR(at(grid, 0.5 - 5e-7, 0.6 + 5e-7, 1.5), 1, 1e-12);  // as rounded to 6 decimals
  EXPECT_TRUE(std::isnan(at(grid, 0.49, 0.45, 1.5)));
  EXPECT_TRUE(std::isnan(at(grid, 0.5, 0.61, 1.5)));
  EXPECT_TRUE(std::isnan(at(grid, 0.5, 0.29, 1.5)));
  EXPECT_TRUE(std::isnan(at(grid, 0.5, 0.45, 0.9)));
  EXPECT_TRUE(std::isnan(at(grid, 0.5, 0.45, 2.1)));
  EXPECT_TRUE(std::isnan(at(grid, 0.6, 0.5, 1.5)));  // the second light has one exit zenith only
  EXPECT_TRUE(std::isnan(at(grid, 0.7, 0.6, 1.5)));  // beside the hole
  EXPECT_NEAR(at(grid, 0.7, 0.6, 1.0), 1, 1e-12);
  EXPECT_TRUE(std::isnan(at(grid, 0.5, 2.0, 1.5)));  // below the horizon
}

TEST(OpenMaterialGrid, WavelengthsMayHaveGridsOfTheirOwn) {
  const auto grid = table::read_openmaterial_grid(
      document("5e-7, 6e-7",
               "[5e-7, 0, 0.1, 0, 1], [5e-7, 0, 0.3, 0, 3], [6e-7, 0, 0.2, 0, 20],"
               "[6e-7, 0, 0.4, 0, 40]"),
      "t.xompt");
  std::vector<double> f_r(2);
  grid.f_r({0, 0, 1}, brdf::direction_from_radians(0.25, 1), f_r);
  EXPECT_NEAR(f_r[0], 2.5, 1e-12);
  EXPECT_NEAR(f_r[1], 25, 1e-12);
  grid.f_r({0, 0, 1}, brdf::direction_from_radians(0.35, 1), f_r);
  EXPECT_TRUE(std::isnan(f_r[0]));
  EXPECT_NEAR(f_r[1], 35, 1e-12);
}

// The published examples ---------------------------------------------------------------------

/// The rows, by a reader that is not this one.
nlohmann::json published(const std::string& path) {
  return nlohmann::json::parse(content_of(path));
}

TEST(OpenMaterialData, TheCamerasAsphaltHas32WavelengthsAnd59Lights) {
  GONIO_REAL_DATA_OR_SKIP(path, "openmaterial/example_material_camera_brdf.xompt");
  const std::string content = content_of(path);
  ASSERT_TRUE(table::is_openmaterial(content));
  const SampleTable t = read_text(content);
  const nlohmann::json rows = published(path)["brdf"]["lookupTable"];
  EXPECT_EQ(t.name, "asphalt_brdf_for_camera");
  ASSERT_EQ(t.channels.size(), 32U);
  EXPECT_EQ(t.channels.front(), "390nm");
  EXPECT_EQ(t.channels.back(), "700nm");
  ASSERT_EQ(t.size(), 59U);
  ASSERT_EQ(t.weight.size(), 59U);
  EXPECT_THAT(t.mask, Each(MaskReason::none));
  for (std::size_t row = 0; row < rows.size(); ++row) {
    ASSERT_EQ(t.values[row / 59][row % 59], rows[row][4].get<double>());
    ASSERT_NEAR(t.wi.x[row % 59], std::sin(rows[row][1].get<double>()), 1e-15);
    ASSERT_EQ(t.wo.z[row % 59], 1);
  }
  // A solid angle that grows with the sine.
  EXPECT_NEAR(t.weight[40] / t.weight[20],
              std::sin(rows[40][1].get<double>()) / std::sin(rows[20][1].get<double>()), 1e-4);
}

TEST(OpenMaterialData, TheLidarsAsphaltIsAPlaneOfExitZeniths) {
  GONIO_REAL_DATA_OR_SKIP(path, "openmaterial/example_material_lidar_brdf.xompt");
  const std::string content = content_of(path);
  const SampleTable t = read_text(content);
  const nlohmann::json rows = published(path)["brdf"]["lookupTable"];
  EXPECT_THAT(t.channels, ElementsAre("905nm"));
  ASSERT_EQ(t.size(), rows.size());
  ASSERT_EQ(t.weight.size(), rows.size());
  std::size_t horizontal = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    ASSERT_EQ(t.values[0][row], rows[row][4].get<double>());
    if (t.mask[row] == MaskReason::horizon) ++horizontal;
  }
  // A light at 90 deg with 181 exit directions; two exit directions at 90 deg of each other light.
  EXPECT_EQ(horizontal, 181U + 4 * 2);
  const auto grid = table::read_openmaterial_grid(content, path);
  // Halfway between lights 0 and 1, on either side, where the values of each are the same.
  EXPECT_NEAR(at(grid, (1.500983 + 1.518436) / 2, 0.5, 0),
              (rows[0][4].get<double>() + rows[181][4].get<double>()) / 2, 1e-15);
}

}  // namespace
}  // namespace gonio::tests
