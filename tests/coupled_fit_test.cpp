// Fits of Ashikhmin-Shirley's coupled model and of its kind as users meet them: any number of
// threads and of channels, a turned tangent, and the test of the isotropic against the anisotropic.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "fit/fit.h"
#include "fit/nested.h"
#include "instrument/synthesize.h"
#include "table/parallel.h"
#include "tests/drawn_recipe.h"

namespace gonio::tests {
namespace {

std::string identifier(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

class FitOnThreads : public testing::TestWithParam<std::string> {};

TEST_P(FitOnThreads, HasTheSameBits) {
  const brdf::Model model(GetParam());
  instrument::Recipe recipe = two_channel_recipe(model, 8);
  // More than 4096 samples: several tasks.
  recipe.hemisphere = {.theta_step_deg = 4, .phi_step_deg = 6};
  const table::SampleTable table = instrument::synthesize(recipe);
  ASSERT_GT(table.size(), 4096U);
  for (const fit::Options& options :
       {fit::Options{.metric = fit::Metric::cosine_l2}, fit::Options{.metric = fit::Metric::chi2},
        fit::Options{.metric = fit::Metric::log, .loss = fit::Loss::huber}}) {
    std::optional<fit::FitResult> first;
    for (const int threads : {1, 2, 3, 7}) {
      fit::Options with_threads = options;
      with_threads.threads = threads;
      const fit::FitResult result = fit::fit(model, table, with_threads);
      if (!first) first = result;
      EXPECT_EQ(result.values.shape, first->values.shape) << threads;
      EXPECT_EQ(result.values.amplitudes, first->values.amplitudes) << threads;
      EXPECT_EQ(result.uncertainty.covariance, first->uncertainty.covariance) << threads;
      EXPECT_EQ(result.cost, first->cost) << threads;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, FitOnThreads,
                         testing::Values("strauss", "ashikhmin-shirley-aniso", "oren-nayar-full",
                                         "lambert+ashikhmin-shirley"),
                         [](const auto& instance) { return identifier(instance.param); });

class FitOfAHundredChannels : public testing::TestWithParam<std::string> {};

TEST_P(FitOfAHundredChannels, FindsThemAll) {
  constexpr std::size_t channels = 100;
  const brdf::Model model(GetParam());
  RecipeDraw draw(11);
  instrument::Recipe recipe = draw.recipe(model);
  recipe.incidence_angles_deg = {20, 60};
  recipe.sample_rotations_deg = {0};
  recipe.channels.clear();
  for (const brdf::ModelParameter& p : model.amplitudes()) recipe.parameters[p.name].clear();
  for (std::size_t c = 0; c < channels; ++c) {
    recipe.channels.push_back("c" + std::to_string(c));
    for (const brdf::ModelParameter& p : model.amplitudes()) {
      recipe.parameters[p.name].push_back(draw.parameter(p.descriptor));
    }
  }
  const fit::FitResult result = fit::fit(model, instrument::synthesize(recipe), {});
  EXPECT_TRUE(result.converged);
  const fit::ParameterValues truth = truth_of(recipe, model);
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    // The figure for noise-free tables.
    const double value = truth[result.unknowns[u]];
    EXPECT_NEAR(result.values[result.unknowns[u]], value, 1e-7 * value) << result.unknowns[u].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, FitOfAHundredChannels, testing::Values("strauss", "ashikhmin-shirley"),
                         [](const auto& instance) { return identifier(instance.param); });

TEST(TurnedExponents, AreNarrowAlongTheTangent) {
  const brdf::Model model("ashikhmin-shirley-aniso", brdf::Frame::free);
  constexpr double pi = std::numbers::pi;
  for (const double psi : {-1.4, -0.5, 0.0, 0.3, 1.2}) {
    for (const bool swapped : {false, true}) {
      instrument::Recipe recipe = RecipeDraw(3).recipe(brdf::Model(model.name()));
      // The same material twice: its two descriptions are a quarter turn apart.
      recipe.parameters["nu"] = {swapped ? 20.0 : 150.0};
      recipe.parameters["nv"] = {swapped ? 150.0 : 20.0};
      recipe.parameters["psi"] = {swapped ? psi + (psi > 0 ? -pi / 2 : pi / 2) : psi};
      const fit::FitResult result = fit::fit(model, instrument::synthesize(recipe), {});
      ASSERT_EQ(model.shape()[2].name, "psi");
      EXPECT_NEAR(result.values.shape[0], 150, 150e-7) << psi << swapped;
      EXPECT_NEAR(result.values.shape[1], 20, 20e-7) << psi << swapped;
      EXPECT_NEAR(result.values.shape[2], psi, 1e-7) << psi << swapped;
    }
  }
}

TEST(TestOfIsotropy, RejectsAnIsotropicMaterialAsOftenAsItSays) {
  constexpr std::size_t repetitions = 200;
  const brdf::Model plain("ashikhmin-shirley");
  const brdf::Model rich("ashikhmin-shirley-aniso");
  std::vector<double> p_values(repetitions);
  table::parallel_for(repetitions, 0, [&](std::size_t repetition) {
    instrument::Recipe recipe = two_channel_recipe(plain, 5);
    recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = 500 + repetition};
    const table::SampleTable table = instrument::synthesize(recipe);
    const fit::Options options{.metric = fit::Metric::chi2, .threads = 1};
    std::array<fit::FitResult, 2> results{fit::fit(plain, table, options),
                                          fit::fit(rich, table, options)};
    fit::compare_nested(results);
    p_values[repetition] = results[0].nested ? results[0].nested->p_value : -1;
  });
  // Uniform between 0 and 1: chance leaves a count outside these quantiles once in 1e4 studies.
  for (const double level : {0.05, 0.25, 0.5, 0.75, 0.95}) {
    const auto count = double(std::count_if(p_values.begin(), p_values.end(),
                                            [&](double p) { return 0 <= p && p < level; }));
    const boost::math::binomial distribution(double(repetitions), level);
    EXPECT_GE(count, boost::math::quantile(distribution, 5e-5)) << level;
    EXPECT_LE(count, boost::math::quantile(boost::math::complement(distribution, 5e-5))) << level;
    std::printf("p < %.2f in %.1f %% of the tables\n", level, 100 * count / repetitions);
  }
}

TEST(TestOfIsotropy, RejectsAnAnisotropicMaterial) {
  const brdf::Model plain("ashikhmin-shirley");
  const brdf::Model rich("ashikhmin-shirley-aniso");
  instrument::Recipe recipe = two_channel_recipe(rich, 5);
  recipe.parameters["nu"] = {40};
  recipe.parameters["nv"] = {60};
  recipe.noise.relative = 0.02;
  const table::SampleTable table = instrument::synthesize(recipe);
  std::array<fit::FitResult, 2> results{fit::fit(plain, table, {.metric = fit::Metric::chi2}),
                                        fit::fit(rich, table, {.metric = fit::Metric::chi2})};
  fit::compare_nested(results);
  ASSERT_TRUE(results[0].nested.has_value());
  EXPECT_LT(results[0].nested->p_value, 1e-4);
}

}  // namespace
}  // namespace gonio::tests
