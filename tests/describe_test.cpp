// What `gonio info` says of a table, on tables whose answers follow from a closed form.
#include "table/describe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "brdf/model.h"
#include "table/read.h"
#include "tests/real_data.h"

namespace gonio::table {
namespace {

using brdf::Direction;
using brdf::direction_from_degrees;
using testing::HasSubstr;
using Value = std::function<double(const Direction<double>&, const Direction<double>&)>;

SampleTable empty_table() {
  SampleTable table;
  table.channels = {"Y"};
  table.values.resize(1);
  return table;
}

void add(SampleTable& table, const Direction<double>& wi, const Direction<double>& wo,
         double value) {
  const std::size_t i = table.size();
  table.wi.resize(i + 1);
  table.wo.resize(i + 1);
  table.wi.set(i, wi);
  table.wo.set(i, wo);
  table.values[0].push_back(value);
  table.mask.push_back(MaskReason::none);
}

/// A goniometer's grid: exitant directions every `step` degrees of theta and 10 of phi.
SampleTable goniometer_table(const std::vector<double>& incidences, const Value& value,
                             double phi_i = 0, double step = 2, double last_theta = 88) {
  SampleTable table = empty_table();
  for (const double theta_i : incidences) {
    const auto wi = direction_from_degrees(theta_i, phi_i);
    for (double theta = 0; theta <= last_theta; theta += step) {
      for (int phi = 0; phi < 360; phi += 10) {
        const auto wo = direction_from_degrees(theta, phi);
        add(table, wi, wo, value(wi, wo));
      }
    }
  }
  return table;
}

Value constant(double value) {
  return [value](const Direction<double>&, const Direction<double>&) { return value; };
}

Value ward(double rho_d, double rho_s, double alpha) {
  return [=, model = brdf::Model("ward-gmd")](const auto& wi, const auto& wo) {
    return model.evaluate(std::vector{rho_d, rho_s}, std::vector{alpha}, wi, wo);
  };
}

/// The integral of f_r cos(theta_o) over the hemisphere by the midpoint rule on the disc.
double integrated_albedo(const Value& f, const Direction<double>& wi) {
  constexpr int rings = 1500, sectors = 720;
  double sum = 0;
  for (int r = 0; r < rings; ++r) {
    const double theta = std::asin(std::sqrt((r + 0.5) / rings));
    for (int s = 0; s < sectors; ++s) {
      sum += f(wi, brdf::direction_from_radians(theta, 2 * std::numbers::pi * s / sectors));
    }
  }
  return std::numbers::pi * sum / (rings * sectors);
}

TEST(Describe, LambertsAlbedoIsItsRhoDAtEveryIncidence) {
  const Description d = describe(goniometer_table({0, 30, 60}, constant(0.5 / std::numbers::pi)));
  ASSERT_EQ(d.incidences.size(), 3U);
  for (const IncidenceSummary& incidence : d.incidences) {
    EXPECT_EQ(incidence.coverage, 1);
    ASSERT_EQ(incidence.albedo.size(), 1U);
    EXPECT_NEAR(incidence.albedo[0].value(), 0.5, 1e-12);
  }
  EXPECT_EQ(d.incidences[1].theta_deg, 30);
  EXPECT_TRUE(d.warnings.empty());
}

TEST(Describe, AlbedoOfALobeAgreesWithItsIntegralOverTheHemisphere) {
  const Value f = ward(0.2, 0.3, 0.15);
  const Description d = describe(goniometer_table({0, 30, 60}, f, 0, 1));
  for (const IncidenceSummary& incidence : d.incidences) {
    const double integral = integrated_albedo(f, direction_from_degrees(incidence.theta_deg, 0));
    // Cells of 1.6 deg under a lobe of 10 deg: an estimate to a few per cent.
    EXPECT_NEAR(incidence.albedo.at(0).value(), integral, 0.03 * integral) << incidence.theta_deg;
  }
}

TEST(Describe, DenseSamplesInTheLobeDoNotOutweighTheRestOfTheHemisphere) {
  const Value f = ward(0.2, 0.3, 0.15);
  SampleTable table = goniometer_table({30}, f, 0, 1);
  const auto wi = direction_from_degrees(30, 0);
  for (double theta = 20; theta <= 40; theta += 0.25) {
    for (double phi = 170; phi <= 190; phi += 0.5) {
      const auto wo = direction_from_degrees(theta, phi);
      add(table, wi, wo, f(wi, wo));
    }
  }
  const double integral = integrated_albedo(f, wi);
  EXPECT_NEAR(describe(table).incidences.at(0).albedo.at(0).value(), integral, 0.03 * integral);
}

TEST(Describe, GapsInTheCoverageCountLikeTheirSurroundings) {
  // Ward's instrument, sparing: every 20 by 60 deg, and densely about the mirror direction.
  const Value f = ward(0.2, 0.3, 0.1);
  const auto wi = direction_from_degrees(30, 0);
  SampleTable table = empty_table();
  for (double theta = 0; theta <= 80; theta += 20) {
    for (double phi = 0; phi < 360; phi += 60) {
      const auto wo = direction_from_degrees(theta, phi);
      add(table, wi, wo, f(wi, wo));
    }
  }
  for (double theta = 4; theta <= 56; theta += 2) {
    for (double phi = 150; phi <= 210; phi += 4) {
      const auto wo = direction_from_degrees(theta, phi);
      add(table, wi, wo, f(wi, wo));
    }
  }
  const IncidenceSummary incidence = describe(table).incidences.at(0);
  EXPECT_LT(incidence.coverage, 0.6);
  const double integral = integrated_albedo(f, wi);
  // Half of the hemisphere rests on a few samples of the diffuse term: a tenth is good.
  EXPECT_NEAR(incidence.albedo.at(0).value(), integral, 0.1 * integral);
}

TEST(Describe, CoverageIsTheShareOfTheProjectedSolidAngle) {
  // theta up to 60 deg covers sin^2(60) = 3/4 of the disc: 12 of 16 rings of equal area.
  const SampleTable cap = goniometer_table({0}, constant(1), 0, 1, 59.9);
  EXPECT_EQ(describe(cap).incidences.at(0).coverage, 0.75);
  EXPECT_EQ(describe(cap).incidences.at(0).cells, 16U * 24U);

  // A table of every 5 or 10 deg is no table full of gaps.
  for (const double step : {5.0, 10.0}) {
    const SampleTable coarse = goniometer_table({40}, constant(1), 0, step, 85);
    EXPECT_EQ(describe(coarse).incidences.at(0).coverage, 1) << step;
  }
}

TEST(Describe, AScanWithinThePlaneOfIncidenceGetsNoAlbedoAndNoAnisotropy) {
  SampleTable table = empty_table();
  const auto wi = direction_from_degrees(30, 180);
  for (double theta = -80; theta <= 80; theta += 1) {
    add(table, wi, direction_from_degrees(theta, 0), 0.1);
  }
  const Description d = describe(table);
  EXPECT_LT(d.incidences.at(0).coverage, 0.25);
  EXPECT_TRUE(d.incidences.at(0).albedo.empty());
  EXPECT_GT(d.half_vectors.along_x, 100U);
  EXPECT_EQ(d.half_vectors.along_y, 0U);
  EXPECT_FALSE(d.half_vectors.both);
  EXPECT_TRUE(describe(goniometer_table({30}, constant(1))).half_vectors.both);
}

TEST(Describe, ReciprocityIsTestedOnSwappedPairsWhereTheyExist) {
  // Incidences at every exitant direction of a 20 x 30 deg grid: each pair has its swapped one.
  const auto table_of = [](const Value& f) {
    SampleTable table = empty_table();
    for (int ti = 20; ti <= 60; ti += 20)
      for (int pi = 0; pi < 360; pi += 30)
        for (int to = 20; to <= 60; to += 20)
          for (int po = 0; po < 360; po += 30) {
            const auto wi = direction_from_degrees(ti, pi);
            const auto wo = direction_from_degrees(to, po);
            add(table, wi, wo, f(wi, wo));
          }
    return table;
  };
  const auto good = describe(table_of(ward(0.2, 0.3, 0.3))).reciprocity;
  ASSERT_TRUE(good.has_value());
  EXPECT_FALSE(good->assumed_isotropy);
  EXPECT_EQ(good->pairs, 36U * 35U / 2);  // 36 directions, a pair with itself tests nothing
  EXPECT_LT(good->rms_relative, 1e-12);

  // f cos_i instead of f: |cos_i - cos_o| / mean, whose RMS over these angles is known.
  const Description cosine = describe(table_of([](const auto& wi, const auto&) { return wi.z; }));
  double sum = 0;
  int count = 0;
  for (const double a : {20., 40., 60.})
    for (const double b : {20., 40., 60.}) {
      const double x = std::cos(a * std::numbers::pi / 180);
      const double y = std::cos(b * std::numbers::pi / 180);
      // Equal angles: 12 * 11 ordered pairs of directions; different ones: 12 * 12.
      const int pairs = a == b ? 132 : 144;
      sum += pairs * std::pow(2 * (x - y) / (x + y), 2);
      count += pairs;
    }
  EXPECT_NEAR(cosine.reciprocity->rms_relative, std::sqrt(sum / count), 1e-12);
  EXPECT_THAT(cosine.warnings, testing::Contains(HasSubstr("swapping light and viewer")));
}

TEST(Describe, ReciprocityAssumesIsotropyWhereOnlyTheTurnedPairsExist) {
  const auto table = goniometer_table({20, 40, 60}, ward(0.2, 0.3, 0.3), 180);
  const auto reciprocity = describe(table).reciprocity;
  ASSERT_TRUE(reciprocity.has_value());
  EXPECT_TRUE(reciprocity->assumed_isotropy);
  // (20,40), (20,60), (40,60) with |dphi| = 0, 10, .. 180.
  EXPECT_EQ(reciprocity->pairs, 3U * 19U);
  EXPECT_LT(reciprocity->rms_relative, 1e-12);
  EXPECT_FALSE(describe(goniometer_table({21}, constant(1))).reciprocity.has_value());
}

TEST(Describe, ImplausibleAlbedosAreNamed) {
  const auto warnings = [](double f) {
    return describe(goniometer_table({30}, constant(f))).warnings;
  };
  EXPECT_THAT(warnings(0.5), testing::ElementsAre(HasSubstr("channel Y reflects 1.57 times")));
  EXPECT_THAT(warnings(1e-5), testing::ElementsAre(HasSubstr("implausibly small")));
  EXPECT_TRUE(warnings(0.2).empty());
}

TEST(Describe, TheAlbedoOfAGridIsByItsSolidAngles) {
  // f_r = 0.2 but for a cap of 5 deg about the normal with 3, which holds most of the samples.
  SampleTable table = empty_table();
  const auto wi = direction_from_degrees(20, 0);
  const auto add_ring = [&](double lower_deg, double upper_deg, double value) {
    constexpr double radians = std::numbers::pi / 180;
    const double solid_angle = std::cos(lower_deg * radians) - std::cos(upper_deg * radians);
    for (int phi = 0; phi < 360; phi += 10) {
      add(table, wi, direction_from_degrees((lower_deg + upper_deg) / 2, phi), value);
      table.weight.push_back(solid_angle);
    }
  };
  for (int k = 0; k < 50; ++k) add_ring(0.1 * k, 0.1 * (k + 1), 3);
  for (double theta = 5; theta < 90; theta += 5) add_ring(theta, theta + 5, 0.2);
  table.weight_is_solid_angle = true;
  const Description d = describe(table);
  ASSERT_EQ(d.incidences.size(), 1U);
  const double cap = std::pow(std::sin(5 * std::numbers::pi / 180), 2);
  EXPECT_NEAR(d.incidences[0].albedo[0].value(), std::numbers::pi * (0.2 + 2.8 * cap), 2e-3);
  EXPECT_TRUE(d.warnings.empty());
}

TEST(Describe, OneSideOfAnIsotropicMaterialCoversBoth) {
  SampleTable table = empty_table();
  for (int theta = 0; theta <= 88; theta += 2) {
    for (int phi = 0; phi <= 180; phi += 10) {
      add(table, direction_from_degrees(20, 0), direction_from_degrees(theta, phi), 0.2);
    }
  }
  EXPECT_LT(describe(table).incidences[0].coverage, 0.7);
  table.takes_isotropy = true;
  EXPECT_EQ(describe(table).incidences[0].coverage, 1);
}

TEST(Describe, MaskedSamplesHolesAndNegativeValuesAreCounted) {
  SampleTable table = goniometer_table({0}, constant(0.1), 0, 10, 80);  // 9 x 36 samples
  table.mask[3] = MaskReason::horizon;
  table.mask[4] = MaskReason::extrapolated;
  table.mask[5] = MaskReason::extrapolated;
  table.values[0][3] = 1e9;  // masked: must not show
  table.values[0][10] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 20; i < 60; ++i) table.values[0][i] = -0.01;
  const Description d = describe(table);
  EXPECT_EQ(d.samples, 324U);
  EXPECT_EQ(d.used, 321U);
  std::array<std::size_t, mask_reason_count> masked{};
  masked[static_cast<std::size_t>(MaskReason::horizon)] = 1;
  masked[static_cast<std::size_t>(MaskReason::extrapolated)] = 2;
  EXPECT_EQ(d.masked, masked);
  EXPECT_EQ(d.channels.at(0).measured, 320U);
  EXPECT_EQ(d.channels[0].holes, 1U);
  EXPECT_EQ(d.channels[0].negative, 40U);
  EXPECT_EQ(d.channels[0].value.minimum, -0.01);
  EXPECT_EQ(d.channels[0].value.maximum, 0.1);
  EXPECT_EQ(d.theta_o_deg.maximum, 80);
  EXPECT_THAT(d.warnings, testing::Contains(HasSubstr("12.5 % of the values of channel Y")));
}

TEST(Describe, ATableWithNothingLeftIsDescribedAndWarnedOf) {
  SampleTable table = goniometer_table({0}, constant(0.1));
  for (MaskReason& reason : table.mask) reason = MaskReason::hole;
  const Description d = describe(table);
  EXPECT_EQ(d.used, 0U);
  EXPECT_TRUE(d.incidences.empty());
  EXPECT_THAT(d.warnings, testing::ElementsAre(HasSubstr("every sample is masked")));
}

/// Directions spread evenly over the disc by the golden angle, another one for wi and wo.
SampleTable spread_table(std::size_t count) {
  SampleTable table = empty_table();
  table.channels = {"R", "G", "B"};
  table.values.assign(3, std::vector<double>(count, 0.25 / std::numbers::pi));
  table.mask.assign(count, MaskReason::none);
  table.wi.resize(count);
  table.wo.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double k = static_cast<double>(i);
    const double n = static_cast<double>(count);
    const auto direction = [](double u, double turns) {
      return brdf::direction_from_radians(std::asin(std::sqrt(0.97 * u)),
                                          2 * std::numbers::pi * turns);
    };
    table.wi.set(i, direction((k + 0.5) / n, std::fmod(k * 0.618033988749895, 1)));
    table.wo.set(
        i, direction(std::fmod(k * 0.754877666246693, 1), std::fmod(k * 0.569840290998053, 1)));
  }
  return table;
}

TEST(Describe, DirectionsThatAllDifferAreBinnedByFifteenDegrees) {
  const Description d = describe(spread_table(20000));
  EXPECT_TRUE(d.incidence_binned);
  ASSERT_EQ(d.incidences.size(), 6U);
  EXPECT_EQ(d.incidences[0].theta_deg, 7.5);
  std::size_t samples = 0;
  for (const IncidenceSummary& bin : d.incidences) {
    samples += bin.samples;
    EXPECT_GT(bin.coverage, 0.9);
    EXPECT_NEAR(bin.albedo.at(2).value(), 0.25, 1e-12);
  }
  EXPECT_EQ(samples, 20000U);
  EXPECT_FALSE(d.reciprocity.has_value());
}

TEST(Describe, AMillionSamplesAreDescribedWhileOneWaits) {
  const SampleTable table = spread_table(1'000'000);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(describe(table).used, 1'000'000U);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  RecordProperty("seconds", std::to_string(seconds.count()));
  // Wide of any machine's noise: something of quadratic cost would take minutes.
  EXPECT_LT(seconds.count(), 20);
}

TEST(DescribeRealData, ThePaintsAreReciprocalPlausibleAndCoveredTo75Degrees) {
  GONIO_REAL_DATA_OR_SKIP(path, "paints/C8_Silver.astm");
  const Description d = describe(read(path));
  EXPECT_EQ(d.samples, 12964U);
  EXPECT_EQ(d.theta_o_deg.maximum, 75);  // beyond it the file holds a ramp
  ASSERT_EQ(d.incidences.size(), 4U);
  // sin^2(75 deg) = 0.933: 15 of 16 rings.
  for (const IncidenceSummary& incidence : d.incidences) EXPECT_EQ(incidence.coverage, 15. / 16);
  ASSERT_TRUE(d.reciprocity.has_value());
  EXPECT_TRUE(d.reciprocity->assumed_isotropy);
  EXPECT_LT(d.reciprocity->rms_relative, 0.12);  // the data's notes say 2 to 12 %
  EXPECT_TRUE(d.warnings.empty());
  EXPECT_TRUE(d.half_vectors.both);
}

}  // namespace
}  // namespace gonio::table
