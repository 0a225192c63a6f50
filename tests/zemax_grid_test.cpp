// Zemax tabular BSDFs between their samples, and real ones: coatings and a camera sensor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "table/file_error.h"
#include "table/formats/zemax.h"
#include "table/sample_table.h"
#include "tests/real_data.h"
#include "tests/run_gonio.h"
#include "tests/zemax_text.h"

namespace gonio::tests {
namespace {

using table::GriddedTable;
using table::MaskReason;
using table::SampleTable;
using testing::ElementsAre;
using testing::HasSubstr;
using zemax::at;
using zemax::count;
using zemax::degree;
using zemax::directions;
using zemax::ones;
using zemax::parse;
using zemax::Reflectance;
using zemax::steps;
using zemax::Text;

TEST(ZemaxGrid, IsLinearInEachOfTheFourAnglesOfTheIncidentDirectionAskedFor) {
  Text text;
  text.symmetry = "Asymmetrical4D";
  text.rotations = steps(0, 270, 90);
  text.azimuths = steps(0, 340, 20);
  text.radials = steps(0, 180, 20);
  // A product of broken lines over the nodes; those of the circles close at the whole turn.
  const auto wave = [](double angle) { return 1 + std::abs(std::remainder(angle, 360)); };
  const Reflectance f = [&](double r, double i, double a, double d) {
    return wave(r) * (1 + i) * wave(a) * (300 - d);
  };
  const GriddedTable grid = table::read_zemax_grid(text.monochrome(f), "t.bsdf");
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(0, 1);
  for (int k = 0; k < 2000; ++k) {
    const double r = 360 * any(random);
    const double i = 20 + 20 * any(random);
    const double a = 360 * any(random);
    const double d = 30 * any(random);  // all nodes about it are above the horizon
    const double value = at(grid, r, i, a, d);
    ASSERT_NEAR(value, f(r, i, a, d), 1e-11 * f(r, i, a, d)) << r << " " << i << " " << a;
  }
}

TEST(ZemaxGrid, FoldsTheSideThatIsNotListed) {
  const GriddedTable grid = table::read_zemax_grid(
      Text().monochrome([](double, double, double a, double) { return 1 + a; }), "t.bsdf");
  EXPECT_NEAR(at(grid, 0, 30, 75, 20), 76, 1e-10);
  EXPECT_NEAR(at(grid, 0, 30, 285, 20), 76, 1e-10);
  EXPECT_NEAR(at(grid, 123, 30, 285, 20), 76, 1e-10) << "one rotation: isotropic";
}

TEST(ZemaxGrid, IsUndefinedBeyondTheListsAndBesideHoles) {
  Text text;
  text.incidences = {20, 40};
  text.radials = steps(0, 60, 10);
  const GriddedTable grid =
      table::read_zemax_grid(text.monochrome([](double, double, double a, double d) {
        return a == 90 && d > 40 ? 0. : 1;
      }),
                             "t.bsdf");
  EXPECT_EQ(at(grid, 0, 20, 30, 10), 1);
  EXPECT_EQ(at(grid, 0, 40, 30, 10), 1);
  EXPECT_TRUE(std::isnan(at(grid, 0, 19.9, 30, 10)));
  EXPECT_TRUE(std::isnan(at(grid, 0, 40.1, 30, 10)));
  EXPECT_EQ(at(grid, 0, 30, 30, 60), 1);
  EXPECT_TRUE(std::isnan(at(grid, 0, 30, 30, 60.1)));
  EXPECT_TRUE(std::isnan(at(grid, 0, 30, 80, 45))) << "azimuth 90, radial 50 is a hole";
  EXPECT_TRUE(std::isnan(at(grid, 0, 30, 90, 45)));
  EXPECT_EQ(at(grid, 0, 30, 60, 45), 1) << "on the node beside it, the hole has no part";
  EXPECT_EQ(at(grid, 0, 30, 90, 40), 1);
  EXPECT_TRUE(std::isnan(at(grid, {0.5, 0, -0.8}, {0, 0, 1})));
  EXPECT_TRUE(std::isnan(at(grid, directions(0, 30, 0, 0).first, {1, 0, 0})));
}

TEST(ZemaxGrid, NothingIsKnownAcrossAGapOfTheCircle) {
  Text text;
  text.symmetry = "Asymmetrical4D";
  text.azimuths = steps(0, 360, 30);
  text.rotations = steps(0, 90, 30);
  const GriddedTable grid = table::read_zemax_grid(text.monochrome(ones), "t.bsdf");
  EXPECT_EQ(at(grid, 75, 30, 30, 10), 1);
  EXPECT_TRUE(std::isnan(at(grid, 100, 30, 30, 10)));
  EXPECT_TRUE(std::isnan(at(grid, 350, 30, 30, 10)));
}

// Real files ---------------------------------------------------------------------------------

struct RealFile {
  const char* file;
  std::size_t rotations, samples, horizon, padding;
};

/// The counts were taken from the files by a script of its own: of the samples above the horizon,
/// all that are 0: those beyond 80 deg and, at 70 deg incidence on the sensor, 13 per rotation
/// behind the lamp.
class ZemaxData : public testing::TestWithParam<RealFile> {};

TEST_P(ZemaxData, HolesAreWhatTheFilesFillWithZeros) {
  GONIO_REAL_DATA_OR_SKIP(path, std::string("zemax/") + GetParam().file);
  const SampleTable t = parse(content_of(path));
  EXPECT_EQ(t.size(), GetParam().samples);
  EXPECT_EQ(count(t, MaskReason::horizon), GetParam().horizon);
  EXPECT_EQ(count(t, MaskReason::padding), GetParam().padding);
  double largest_theta = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (t.mask[i] != MaskReason::none) continue;
    ASSERT_GT(t.values[0][i], 0);
    largest_theta = std::max(largest_theta, std::acos(t.wo.z[i]) / degree);
  }
  EXPECT_NEAR(largest_theta, 80, 1e-9);
}

TEST_P(ZemaxData, TheGridGivesBackTheSamplesInTheirDirections) {
  GONIO_REAL_DATA_OR_SKIP(path, std::string("zemax/") + GetParam().file);
  const std::string content = content_of(path);
  const SampleTable t = parse(content);
  const GriddedTable grid = table::read_zemax_grid(content, path);
  // The sensor's rotation of 360 deg is a mirrored copy of that of 0, which the grid holds to.
  const std::size_t rotations = GetParam().rotations;
  const std::size_t compared = rotations == 1 ? t.size() : t.size() / rotations * (rotations - 1);
  for (std::size_t i = 0; i < compared; ++i) {
    if (t.mask[i] == MaskReason::none) {
      ASSERT_NEAR(at(grid, t.wi[i], t.wo[i]), t.values[0][i], 1e-9 * t.values[0][i]) << i;
    } else {
      ASSERT_TRUE(std::isnan(at(grid, t.wi[i], t.wo[i]))) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, ZemaxData,
                         testing::Values(RealFile{"AnoBlackEC1onAlum.bsdf", 1, 912, 134, 59},
                                         RealFile{"AnoBlackEC2onAlum.bsdf", 1, 912, 134, 59},
                                         RealFile{"AnoBlackNiTEonINVAR.bsdf", 1, 912, 134, 59},
                                         RealFile{"AnoBlackNiTEonSteel.bsdf", 1, 912, 134, 59},
                                         RealFile{"IMX455.bsdf", 37, 114996, 51800, 6993}),
                         [](const auto& instance) {
                           const std::string name = instance.param.file;
                           return name.substr(0, name.find('.'));
                         });

TEST(ZemaxData, TheCoatingsAreReciprocalInThePlaneOfIncidence) {
  // 2 to 4 per cent in the mean. Were azimuth 0 to point away from the normal, or the values to
  // hold a cosine, it would be a third and more. The pair 50, 70 deg is left out: on one of the
  // coatings the measurements themselves differ by 26 per cent.
  for (const char* file : {"AnoBlackEC1onAlum.bsdf", "AnoBlackEC2onAlum.bsdf",
                           "AnoBlackNiTEonINVAR.bsdf", "AnoBlackNiTEonSteel.bsdf"}) {
    GONIO_REAL_DATA_OR_SKIP(path, std::string("zemax/") + file);
    const GriddedTable grid = table::read_zemax_grid(content_of(path), path);
    double sum = 0;
    for (const auto& [a, b] :
         std::vector<std::pair<double, double>>{{10, 30}, {30, 50}, {10, 50}, {30, 70}}) {
      const auto wi = brdf::direction_from_degrees(a, 0);
      const auto wo = brdf::direction_from_degrees(b, 180);
      sum += std::abs(std::log(at(grid, wi, wo) / at(grid, wo, wi)));
    }
    EXPECT_LT(sum / 4, 0.06) << file;
  }
}

TEST(ZemaxData, TheSensorNamesItselfAndTheUnknownSenseOfRotation) {
  GONIO_REAL_DATA_OR_SKIP(path, "zemax/IMX455.bsdf");
  const SampleTable t = parse(content_of(path));
  EXPECT_EQ(t.name, "IMX455 lenslet array w/o cover glass");
  EXPECT_THAT(t.notes, ElementsAre(HasSubstr("6993 samples are zeros"),
                                   HasSubstr("rotations 0 and 360 are one setting"),
                                   HasSubstr("the sense of SampleRotation is not known")));
}

}  // namespace
}  // namespace gonio::tests
