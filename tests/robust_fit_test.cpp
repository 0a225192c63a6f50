// What a robust loss is for: outliers neither move the parameters nor spoil the intervals.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "table/parallel.h"
#include "tests/every_metric.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

constexpr std::array robust_losses{fit::Loss::huber, fit::Loss::cauchy, fit::Loss::tukey};

double truth_of(const instrument::Recipe& recipe, const fit::Unknown& unknown) {
  return recipe.parameters.at(unknown.parameter).front();
}

/// Multiplies one in fifty of the readings, drawn by `seed`, by one of two factors.
void spoil(table::SampleTable& table, double factor, double other_factor, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (double& value : table.values[0]) {
    if (random() % 50 == 0) value *= random() % 2 == 0 ? factor : other_factor;
  }
}

class ALossAgainstOutliers : public testing::TestWithParam<std::tuple<fit::Loss, fit::Metric>> {};

TEST_P(ALossAgainstOutliers, RecoversATableWithoutNoise) {
  const auto [loss, metric] = GetParam();
  for (const WardMaterial& material : ward_materials) {
    const instrument::Recipe recipe = ward_recipe(material, "ward-aniso");
    table::SampleTable table = instrument::synthesize(recipe);
    spoil(table, 20, 20, 3);
    const fit::FitResult result =
        fit::fit(brdf::Model("ward-aniso"), table, {.metric = metric, .loss = loss});
    EXPECT_TRUE(result.converged) << material.name;
    for (const fit::Unknown& unknown : result.unknowns) {
      EXPECT_NEAR(result.values[unknown] / truth_of(recipe, unknown), 1, 1e-6)
          << material.name << " " << unknown.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Every, ALossAgainstOutliers,
                         testing::Combine(testing::ValuesIn(robust_losses),
                                          testing::Values(fit::Metric::l2, fit::Metric::cosine_l2,
                                                          fit::Metric::log, fit::Metric::cube_root,
                                                          fit::Metric::relative)),
                         [](const auto& instance) { return name_of(instance); });

/// Two incidences on ivory plastic, with noise of 2 % + 1e-3.
instrument::Recipe plastic_recipe() {
  instrument::Recipe recipe = ward_recipe(ward_materials[8], "ward");
  recipe.incidence_angles_deg = {20, 50};
  recipe.sample_rotations_deg = {0};
  recipe.noise = {.relative = 0.02, .floor = 1e-3};
  return recipe;
}

constexpr std::size_t repetitions = 300;
// The standard deviation of a share of 95 % in 300 repetitions is 1.26 %; 3.5 of them.
constexpr double tolerance = 0.044;

struct Coverage {
  std::array<double, 3> inside{};  // rho_d, rho_s, alpha: the share of 95 % intervals
  std::array<double, 3> bias{};    // mean error in standard deviations
  std::size_t not_converged = 0;
};

/// Of 300 tables of which one value in fifty is multiplied by one of the factors.
Coverage coverage(fit::Loss loss, double factor, double other_factor) {
  std::vector<std::optional<fit::FitResult>> results(repetitions);
  table::parallel_for(repetitions, 0, [&](std::size_t k) {
    instrument::Recipe recipe = plastic_recipe();
    recipe.noise.seed = k;
    table::SampleTable table = instrument::synthesize(recipe);
    spoil(table, factor, other_factor, 1000 + k);
    results[k].emplace(fit::fit(brdf::Model("ward"), table, {.loss = loss, .threads = 1}));
  });
  const instrument::Recipe recipe = plastic_recipe();
  Coverage coverage;
  for (const auto& done : results) {
    const fit::FitResult& result = *done;
    coverage.not_converged += result.converged ? 0 : 1;
    for (std::size_t u = 0; u < coverage.inside.size(); ++u) {
      const double truth = truth_of(recipe, result.unknowns[u]);
      const auto& [low, high] = *result.uncertainty.interval95[u];
      coverage.inside[u] += low <= truth && truth <= high ? 1.0 / repetitions : 0;
      coverage.bias[u] +=
          (result.values[result.unknowns[u]] - truth) / *result.uncertainty.stddev[u] / repetitions;
    }
  }
  return coverage;
}

void print(fit::Loss loss, const char* outliers, const Coverage& c) {
  std::printf(
      "%-6s %-18s 95 %% intervals hold rho_d %.3f rho_s %.3f alpha %.3f; mean error "
      "%+.2f %+.2f %+.2f stddev; not converged %zu\n",
      std::string(fit::name(loss)).c_str(), outliers, c.inside[0], c.inside[1], c.inside[2],
      c.bias[0], c.bias[1], c.bias[2], c.not_converged);
}

class IntervalsUnder : public testing::TestWithParam<fit::Loss> {};

TEST_P(IntervalsUnder, HoldTheTruthInNineteenOfTwentyTablesWithOutliersOnBothSides) {
  // f + 3 f or f - 3 f: whatever such outliers pull, they pull both ways.
  const Coverage c = coverage(GetParam(), 4, -2);
  print(GetParam(), "on both sides:", c);
  EXPECT_EQ(c.not_converged, 0u);
  for (const double inside : c.inside) EXPECT_NEAR(inside, 0.95, tolerance);
}

TEST_P(IntervalsUnder, LeanTowardsOutliersOnOneSideByLittle) {
  // Huber's pull is bounded, not nil: 2 % of the values pull with 1.345 standard deviations each,
  // of n values 0.02 * 1.345 * sqrt(n) standard deviations of a mean: about 0.5 for the 380 here.
  const Coverage c = coverage(GetParam(), 20, 20);
  print(GetParam(), "20 times too high:", c);
  EXPECT_EQ(c.not_converged, 0u);
  for (const double bias : c.bias) EXPECT_LT(std::abs(bias), 1.0);
}

INSTANTIATE_TEST_SUITE_P(EveryRobustLoss, IntervalsUnder, testing::ValuesIn(robust_losses),
                         [](const auto& instance) {
                           return std::string(fit::name(instance.param));
                         });

}  // namespace
}  // namespace gonio::tests
