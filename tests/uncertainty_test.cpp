// Standard deviations and intervals against closed forms and against many repetitions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

using std::numbers::pi;
using testing::DoubleNear;
using testing::Each;

/// A white table of `count` samples with noise of the given standard deviation.
table::SampleTable lambert_table(std::size_t count, double stddev, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, stddev);
  table::SampleTable table;
  table.channels = {"Y"};
  table.values.resize(1);
  for (std::size_t i = 0; i < count; ++i) {
    table.wi.push_back({0, 0, 1});
    table.wo.push_back(brdf::direction_from_degrees(60.0 * double(i) / double(count), 0));
    table.values[0].push_back(0.5 / pi + normal(random));
    table.mask.push_back(table::MaskReason::none);
  }
  return table;
}

TEST(Covariance, OfALambertianIsTheMeansUnderEveryAssumption) {
  // rho_d = pi * mean: its standard deviation is pi sigma / sqrt(N) for known sigma, with the
  // sample's own variance (N - 1 in the denominator) else; the sandwich has N / (N - 1) as well.
  const std::size_t count = 400;
  const double sigma = 0.01;
  table::SampleTable table = lambert_table(count, sigma, 1);
  table.sigma.assign(1, std::vector<double>(count, sigma));
  double mean = 0;
  for (const double value : table.values[0]) mean += value / double(count);
  double squares = 0;
  for (const double value : table.values[0]) squares += (value - mean) * (value - mean);
  const double own = pi * std::sqrt(squares / double(count - 1) / double(count));

  const auto stddev_with = [&](fit::Metric metric, fit::Covariance covariance) {
    return *fit::fit(brdf::Model("lambert"), table, {.metric = metric, .covariance = covariance})
                .uncertainty.stddev[0];
  };
  EXPECT_NEAR(stddev_with(fit::Metric::chi2, fit::Covariance::known_sigma),
              pi * sigma / std::sqrt(double(count)), 1e-12);
  EXPECT_NEAR(stddev_with(fit::Metric::l2, fit::Covariance::residual), own, 1e-12);
  EXPECT_NEAR(stddev_with(fit::Metric::l2, fit::Covariance::sandwich), own, 1e-12);
}

TEST(Covariance, IsASandwichUnlessSigmaIsKnownAndExplainsTheResiduals) {
  table::SampleTable table = lambert_table(400, 0.01, 2);
  const brdf::Model model("lambert");
  EXPECT_EQ(fit::fit(model, table, {}).uncertainty.kind, fit::Covariance::sandwich);
  table.sigma.assign(1, std::vector<double>(400, 0.01));
  EXPECT_EQ(fit::fit(model, table, {.metric = fit::Metric::chi2}).uncertainty.kind,
            fit::Covariance::known_sigma);
  table.sigma.assign(1, std::vector<double>(400, 0.001));
  const fit::FitResult misfit = fit::fit(model, table, {.metric = fit::Metric::chi2});
  EXPECT_EQ(misfit.uncertainty.kind, fit::Covariance::sandwich);
  EXPECT_FALSE(misfit.warnings.empty());
}

/// Two incidences on ivory plastic, with 2 % + 1e-3 noise.
instrument::Recipe plastic_recipe() {
  instrument::Recipe recipe = ward_recipe(ward_materials[8], "ward");
  recipe.incidence_angles_deg = {20, 50};
  recipe.sample_rotations_deg = {0};
  recipe.noise = {.relative = 0.02, .floor = 1e-3};
  return recipe;
}

/// How often the 95 % interval of each parameter (rho_d, rho_s, alpha) holds the truth over
/// `repetitions` tables.
std::vector<double> coverage(instrument::Recipe recipe, const fit::Options& options,
                             int repetitions) {
  std::vector<double> inside(3);
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    recipe.noise.seed = std::uint64_t(repetition);
    const fit::FitResult result =
        fit::fit(brdf::Model("ward"), instrument::synthesize(recipe), options);
    for (std::size_t u = 0; u < inside.size(); ++u) {
      const double truth = recipe.parameters.at(result.unknowns[u].parameter).front();
      const auto& [low, high] = *result.uncertainty.interval95[u];
      if (low <= truth && truth <= high) inside[u] += 1.0 / repetitions;
    }
  }
  return inside;
}

constexpr int repetition_count = 400;
// The standard deviation of a share of 95 % in 400 repetitions is 1.1 %; 3.5 of them.
constexpr double tolerance = 0.038;

TEST(Intervals, HoldTheTruthInNineteenOfTwentyTablesWithKnownSigma) {
  instrument::Recipe recipe = plastic_recipe();
  recipe.sigma_columns = true;
  EXPECT_THAT(coverage(recipe, {.metric = fit::Metric::chi2}, repetition_count),
              Each(DoubleNear(0.95, tolerance)));
}

TEST(Intervals, HoldTheTruthInNineteenOfTwentyTablesWithUnknownUnequalNoise) {
  EXPECT_THAT(coverage(plastic_recipe(), {.metric = fit::Metric::cosine_l2}, repetition_count),
              Each(DoubleNear(0.95, tolerance)));
}

TEST(Intervals, OfTheResidualsVarianceFailWhereTheNoiseIsUnequal) {
  // Why the sandwich is the default: the noise of the few bright samples decides about rho_s, and
  // the common variance, mostly of dim ones, is far below it.
  instrument::Recipe recipe = plastic_recipe();
  recipe.hemisphere = {.theta_step_deg = 5, .phi_step_deg = 15};
  recipe.mirror_patch.reset();
  recipe.noise = {.relative = 0.05, .floor = 1e-4};
  const std::vector<double> shares =
      coverage(recipe, {.metric = fit::Metric::l2, .covariance = fit::Covariance::residual},
               repetition_count);
  EXPECT_LT(shares[1], 0.95 - tolerance);
}

}  // namespace
}  // namespace gonio::tests
