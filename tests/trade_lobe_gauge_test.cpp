// What errors are fractions of, and the directions at which they are looked for.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "brdf/albedo.h"
#include "tests/trade_material.h"
#include "trade/lobe_gauge.h"
#include "trade/lobe_grid.h"

namespace gonio::trade {
namespace {

using std::numbers::pi;
using Pairs = std::vector<brdf::DirectionPair<double>>;

/// Of Ward's lobe at 60 degrees, where cos_i cos_o is 1/4: rho_s / (4 pi alpha^2 / 2).
double ward_peak(double rho_s, double alpha) { return rho_s / (2 * pi * alpha * alpha); }

TEST(LobeGauge, IsTheLobesPeakUpTo60DegreesAlsoWherePairsMissTheLobe) {
  const auto model = tests::ward_model(0.5, 0.2, 0.01);
  const Pairs far_from_it{{brdf::direction_from_degrees(30, 0),  //
                           brdf::direction_from_degrees(30, 0)}};
  ASSERT_NEAR(reflectances(model, far_from_it)[0], 0.5 / pi, 1e-12) << "no lobe is seen there";
  const LobeGauge gauge(model, far_from_it);
  EXPECT_NEAR(gauge.peak(0), ward_peak(0.2, 0.01), 1e-9 * ward_peak(0.2, 0.01));
  EXPECT_EQ(gauge.at(0, 0.5 / pi), gauge.peak(0)) << "the diffuse part is no gauge";
}

TEST(LobeGauge, IsTheValueWhereThatExceedsAllUpTo60Degrees) {
  const auto model = tests::ward_model(0.5, 0.2, 0.1);
  const LobeGauge gauge(model, Pairs{});
  const double grazing = reflectances(model, Pairs{tests::mirrored_pair(85)})[0];
  ASSERT_GT(grazing, 4 * gauge.peak(0));  // cos 60 / cos 85 is 5.7
  EXPECT_EQ(gauge.at(0, grazing), grazing);
}

TEST(LobeGauge, OfALobeTooDimToBeSeenIsAThousandthOfAll) {
  const double dim = 1e-7;  // its peak is 4e-6 of the diffuse part's
  const LobeGauge gauge(tests::ward_model(0.5, dim, 0.3), Pairs{});
  EXPECT_NEAR(gauge.peak(0), 1e-3 * 0.5 / pi, 1e-5 * 1e-3 * 0.5 / pi);
  EXPECT_GT(gauge.peak(0), 10 * ward_peak(dim, 0.3));
}

TEST(LobeGauge, IsAboveZeroForAChannelWithoutALobe) {
  EXPECT_NEAR(LobeGauge(tests::ward_model(0.5, 0, 0.1), Pairs{}).peak(0), 0.5 / pi, 1e-12);
  EXPECT_EQ(LobeGauge(tests::ward_model(0, 0, 0.1), Pairs{}).peak(0), 1);
}

/// The sums of f_r cos_o over the grid for light from 0 degrees, of one azimuth.
double albedo_by(const std::vector<WeightedPair>& grid, const brdf::BoundModel& model,
                 const brdf::Direction<double>& wi) {
  double sum = 0;
  for (const auto& [pair, weight] : grid) {
    if (pair.wi.x != wi.x || pair.wi.y != wi.y || pair.wi.z != wi.z) continue;
    sum += reflectances(model, Pairs{pair})[0] * pair.wo.z * weight;
  }
  return sum;
}

TEST(LobeGrid, IntegratesLobesOfAnyStretch) {
  for (const double alpha_y : {0.1, 0.03, 0.01, 0.002}) {  // up to 50 : 1
    const auto model = tests::brushed_model(0, 1, 0.1, alpha_y);
    const auto grid = lobe_grid(model);
    for (const double phi_deg : {0., 30.}) {
      SCOPED_TRACE(testing::Message() << "alpha_y " << alpha_y << ", phi " << phi_deg);
      const double phi = phi_deg * pi / 180;
      const double expected = brdf::albedo(model, 30 * pi / 180, phi).values[0];
      // The grid ends at 80 degrees: the lobe loses less than 1e-3 there. Sums are good to 1 %.
      EXPECT_NEAR(albedo_by(grid, model, brdf::direction_from_degrees(30, phi_deg)), expected,
                  0.01 * expected);
    }
  }
}

TEST(LobeGrid, StaysWithinTheAnglesOfAFit) {
  const double least = std::cos(80.001 * pi / 180);
  for (const auto& [pair, weight] : lobe_grid(tests::brushed_model(0, 1, 0.2, 0.02))) {
    ASSERT_GE(pair.wi.z, least);
    ASSERT_GE(pair.wo.z, least);
    ASSERT_GE(weight, 0);
  }
}

}  // namespace
}  // namespace gonio::trade
