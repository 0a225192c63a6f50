// What a fit must find again: the parameters that a table was made with.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

double value_of(const fit::FitResult& result, const std::string& name) {
  for (const fit::Unknown& unknown : result.unknowns) {
    if (unknown.name == name || unknown.parameter == name) return result.values[unknown];
  }
  ADD_FAILURE() << "no parameter " << name;
  return NAN;
}

class EveryWardVariant : public testing::TestWithParam<std::string> {};

TEST_P(EveryWardVariant, IsRecoveredFromNoiseFreeTablesOfWardsMaterials) {
  double worst = 0;
  for (const WardMaterial& material : ward_materials) {
    const instrument::Recipe recipe = ward_recipe(material, GetParam());
    const table::SampleTable table = instrument::synthesize(recipe);
    for (const fit::Metric metric : {fit::Metric::l2, fit::Metric::cosine_l2}) {
      const fit::FitResult result = fit::fit(brdf::Model(GetParam()), table, {.metric = metric});
      EXPECT_TRUE(result.converged);
      for (const auto& [parameter, values] : recipe.parameters) {
        const double error = std::abs(value_of(result, parameter) / values.front() - 1);
        worst = std::max(worst, error);
        EXPECT_LE(error, 1e-9) << material.name << " " << parameter;  // the figure
      }
    }
  }
  RecordProperty("worst_relative_error", std::to_string(worst));
  std::printf("%-20s worst relative error of a parameter: %.1e\n", GetParam().c_str(), worst);
}

INSTANTIATE_TEST_SUITE_P(Recovery, EveryWardVariant,
                         testing::Values("ward", "ward-aniso", "ward-approx", "ward-approx-aniso",
                                         "ward-duer", "ward-duer-aniso", "ward-gmd",
                                         "ward-gmd-aniso"),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           for (char& c : name) {
                             if (c == '-') c = '_';
                           }
                           return name;
                         });

TEST(NoisyWardMaterials, LieWithinTheir999PerCentIntervals) {
  std::uint64_t seed = 1;
  for (const WardMaterial& material : ward_materials) {
    instrument::Recipe recipe = ward_recipe(material, "ward-aniso");
    recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = seed++};
    recipe.sigma_columns = true;
    const fit::FitResult result = fit::fit(
        brdf::Model("ward-aniso"), instrument::synthesize(recipe), {.metric = fit::Metric::chi2});
    EXPECT_EQ(result.uncertainty.kind, fit::Covariance::known_sigma);
    for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
      const fit::Unknown& unknown = result.unknowns[u];
      ASSERT_TRUE(result.uncertainty.stddev[u].has_value()) << unknown.name;
      const double truth = recipe.parameters.at(unknown.parameter).front();
      const double deviations = (result.values[unknown] - truth) / *result.uncertainty.stddev[u];
      // The normal distribution's quantile at 99.95 %.
      EXPECT_LE(std::abs(deviations), 3.2905) << material.name << " " << unknown.name;
    }
    // chi-square per degree of freedom: 1 with a standard deviation of sqrt(2 / 2500), times 5.
    EXPECT_NEAR(result.uncertainty.reduced_chi2.value_or(0), 1, 0.15) << material.name;
  }
}

TEST(NoiseFromTheModel, DoesNotPullTheAmplitudesDown) {
  // With sigma from the measured values, low readings count for more: amplitudes come out low by
  // 2 relative^2, here 2 %; the standard deviation of rho_d is a tenth of that.
  instrument::Recipe recipe = ward_recipe(ward_materials[8], "ward");
  recipe.noise = {.relative = 0.1, .floor = 1e-6, .seed = 7};
  const fit::FitResult result =
      fit::fit(brdf::Model("ward"), instrument::synthesize(recipe),
               {.metric = fit::Metric::chi2, .noise = fit::Noise{0.1, 1e-6}});
  EXPECT_TRUE(result.converged);
  const double truth = ward_materials[8].rho_d;
  const double stddev = *result.uncertainty.stddev[0];
  ASSERT_LT(stddev, 0.005 * truth);
  EXPECT_LT(std::abs(value_of(result, "rho_d") - truth), 3.3 * stddev);
  EXPECT_NEAR(*result.uncertainty.reduced_chi2, 1, 0.15);
}

TEST(AFit, GivesTheSameBitsForAnyNumberOfThreads) {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "ward-aniso");
  recipe.hemisphere = {.theta_step_deg = 2, .phi_step_deg = 5};  // 60,000 samples: several tasks
  recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = 3};
  const table::SampleTable table = instrument::synthesize(recipe);
  ASSERT_GT(table.size(), 50000u);
  const fit::FitResult one = fit::fit(brdf::Model("ward-aniso"), table, {.threads = 1});
  for (const int threads : {2, 3, 7}) {
    const fit::FitResult many = fit::fit(brdf::Model("ward-aniso"), table, {.threads = threads});
    EXPECT_EQ(many.values.shape, one.values.shape);
    EXPECT_EQ(many.values.amplitudes, one.values.amplitudes);
    EXPECT_EQ(many.uncertainty.stddev, one.uncertainty.stddev);
    EXPECT_EQ(many.errors, one.errors);
    EXPECT_EQ(many.cost, one.cost);
  }
}

}  // namespace
}  // namespace gonio::tests
