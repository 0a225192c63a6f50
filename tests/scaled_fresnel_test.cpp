// Ngan's form of Ashikhmin and Shirley's model: fitted outside the library's engine, it must agree
// with it where both describe the same material.
#include "bench/scaled_fresnel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "table/file_error.h"

namespace gonio::tests {
namespace {

instrument::Recipe grey_paint() {
  instrument::Recipe recipe;
  recipe.name = "grey paint";
  recipe.model = "lambert+ashikhmin-shirley";
  recipe.channels = {"Y"};
  recipe.parameters = {{"rho_d", {.3}}, {"Rs", {.06}}, {"n", {80}}};
  recipe.incidence_angles_deg = {0, 20, 40, 60, 75};
  recipe.sample_rotations_deg = {0};
  recipe.hemisphere = {.theta_step_deg = 4, .phi_step_deg = 15};
  return recipe;
}

TEST(ScaledFresnel, FindsThePublishedModelAtScaleOne) {
  const table::SampleTable table = instrument::synthesize(grey_paint());
  const bench::ScaledFresnelFit fit = bench::fit_scaled_fresnel(table, 80);
  // The error is the root of sums of squares that cancel to 1e-16: parameters to its root.
  EXPECT_NEAR(fit.n, 80, 80 * 1e-5);
  EXPECT_NEAR(fit.f0, .06, 1e-6);
  ASSERT_EQ(fit.ks.size(), 1u);
  EXPECT_NEAR(fit.ks[0], 1, 1e-5);
  EXPECT_NEAR(fit.kd[0], .3, 1e-6);
  EXPECT_LT(fit.error, 1e-6);
}

TEST(ScaledFresnel, HasAScaleForEachChannelAndOneF0) {
  // The second channel is a quarter of the first.
  table::SampleTable table = instrument::synthesize(grey_paint());
  table.channels = {"A", "B"};
  table.values.push_back(table.values[0]);
  for (double& value : table.values[1]) value *= .25;
  const bench::ScaledFresnelFit fit = bench::fit_scaled_fresnel(table, 80);
  EXPECT_NEAR(fit.f0, .06, 1e-6);
  EXPECT_NEAR(fit.ks[1] / fit.ks[0], .25, 1e-9);
  EXPECT_NEAR(fit.kd[1] / fit.kd[0], .25, 1e-9);
}

TEST(ScaledFresnel, ErrsByAHairLessThanThePublishedModelOnItsOwnNoisyTable) {
  // One parameter more, of three, explains a few of the 2,000 noisy values more: weights, holes and
  // unit are those of the library, or the errors would differ by far more.
  instrument::Recipe recipe = grey_paint();
  recipe.noise = {.relative = .05, .floor = 1e-3, .seed = 4};
  table::SampleTable table = instrument::synthesize(recipe);
  for (std::size_t i = 0; i < table.size(); ++i) {
    table.weight.push_back(std::hypot(table.wo.x[i], table.wo.y[i]));
    if (i % 7 != 0) continue;
    table.values[0][i] = std::nan("");
    table.mask[i] = table::MaskReason::hole;
  }
  const double published =
      fit::fit(brdf::Model("lambert+ashikhmin-shirley"), table, {}).metric_error;
  const double scaled = bench::fit_scaled_fresnel(table, 80).error;
  EXPECT_LT(scaled, published);
  EXPECT_GT(scaled, .99 * published);
}

TEST(ScaledFresnel, IsFarBetterWhereTheHighlightIsWeakerThanItsFresnelFactor) {
  // A sharp lobe of F0 1 and scale .04, as glossy paints have it: with F0 = .04 the published model
  // makes it grow far more towards grazing angles.
  table::SampleTable table = instrument::synthesize(grey_paint());
  const brdf::Model lobe("lambert+ashikhmin-shirley");
  const std::array shape{400.};
  for (std::size_t i = 0; i < table.size(); ++i) {
    table.values[0][i] = .04 * lobe.evaluate(std::array{2.5, 1.}, shape, table.wi[i], table.wo[i]);
  }
  const bench::ScaledFresnelFit fit = bench::fit_scaled_fresnel(table, 80);
  EXPECT_NEAR(fit.f0, 1, 1e-5);
  EXPECT_NEAR(fit.ks[0], .04, 1e-6);
  EXPECT_NEAR(fit.kd[0], .1, 1e-6);
  EXPECT_NEAR(fit.n, 400, .01);
  EXPECT_GT(fit::fit(lobe, table, {}).metric_error, 100 * fit.error);
}

TEST(ScaledFresnel, KeepsAmplitudesFromGoingBelowZero) {
  // A retro-reflection that no lobe of this kind has: the best lobe is none.
  table::SampleTable table = instrument::synthesize(grey_paint());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double cosine = table.wi.x[i] * table.wo.x[i] + table.wi.y[i] * table.wo.y[i] +
                          table.wi.z[i] * table.wo.z[i];
    table.values[0][i] = .1 + .1 * cosine;
  }
  const bench::ScaledFresnelFit fit = bench::fit_scaled_fresnel(table, 80);
  EXPECT_GE(fit.ks[0], 0);
  EXPECT_GE(fit.kd[0], 0);
  const double lambert = fit::fit(brdf::Model("lambert"), table, {}).metric_error;
  EXPECT_LE(fit.error, lambert * (1 + 1e-12));
}

TEST(ScaledFresnel, RefusesATableWithoutMeasurements) {
  table::SampleTable table = instrument::synthesize(grey_paint());
  std::fill(table.mask.begin(), table.mask.end(), table::MaskReason::hole);
  EXPECT_THROW(bench::fit_scaled_fresnel(table, 80), table::FileError);
}

}  // namespace
}  // namespace gonio::tests
