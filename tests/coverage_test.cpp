// Honest error bars: the study of bench/coverage in a short form, and the Cramer-Rao bound it
// measures by.
//
// The limits are the project's figures for 2,000 fits of each material, widened by what chance does
// to fewer: quantiles at a false alarm of 4e-9 each, below 1e-6 for the about 200 numbers checked
// here. The seeds are fixed, so nothing is left to chance from run to run.
#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "bench/coverage_study.h"
#include "bench/cramer_rao.h"
#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

constexpr double false_alarm = 4e-9;
constexpr std::size_t fits_per_material = 80;

/// The recipes of data/synthetic: Ward's ten materials, each with its true model and its noise.
std::vector<instrument::Recipe> recipes() {
  std::set<std::string> paths;
  for (const auto& entry :
       std::filesystem::directory_iterator(GONIO_SOURCE_DIR "/data/synthetic")) {
    if (entry.path().extension() == ".json") paths.insert(entry.path().string());
  }
  std::vector<instrument::Recipe> recipes;
  for (const std::string& path : paths) recipes.push_back(instrument::read_recipe(path));
  return recipes;
}

bench::MaterialCoverage study(const instrument::Recipe& recipe, const bench::Estimator& estimator) {
  return bench::study_coverage(recipe, bench::cramer_rao_bounds(recipe), estimator,
                               fits_per_material, 0);
}

std::vector<bench::MaterialCoverage> study_all(const bench::Estimator& estimator) {
  std::vector<bench::MaterialCoverage> materials;
  for (const instrument::Recipe& recipe : recipes()) materials.push_back(study(recipe, estimator));
  return materials;
}

/// The root mean square of `count` standard normal numbers, at most and at least: their squares sum
/// to a chi-square number.
double largest_rms(std::size_t count) {
  const boost::math::chi_squared distribution{double(count)};
  return std::sqrt(boost::math::quantile(boost::math::complement(distribution, false_alarm)) /
                   double(count));
}
double least_rms(std::size_t count) {
  const boost::math::chi_squared distribution{double(count)};
  return std::sqrt(boost::math::quantile(distribution, false_alarm) / double(count));
}

/// The root mean square of error over standard deviation whose 95 % interval has this coverage.
double pull_of_coverage(double coverage) {
  const boost::math::normal normal;
  return boost::math::quantile(normal, 0.975) / boost::math::quantile(normal, (1 + coverage) / 2);
}

/// What the figure of each coverage says of the standard deviations. 80 fits may all hold the truth
/// within intervals that are honest, or far too wide: the pull sees the latter.
bench::Band pull_limits(const bench::Figures& figures) {
  return {pull_of_coverage(figures.coverage.upper) * least_rms(fits_per_material),
          pull_of_coverage(figures.coverage.lower) * largest_rms(fits_per_material)};
}

double least_coverage(double figure, std::size_t fits) {
  const boost::math::binomial distribution(double(fits), figure);
  return boost::math::quantile(distribution, false_alarm) / double(fits);
}

double largest_coverage(double figure, std::size_t fits) {
  const boost::math::binomial distribution(double(fits), figure);
  return boost::math::quantile(boost::math::complement(distribution, false_alarm)) / double(fits);
}

void expect_honest_intervals(const bench::Estimator& estimator,
                             const std::vector<bench::MaterialCoverage>& materials) {
  const bench::CoverageTotals totals = bench::sum_up(materials);
  EXPECT_EQ(materials.size(), 10u);
  EXPECT_EQ(totals.not_converged, 0u);
  // A switch under chi2 is a reduced chi2 5 standard deviations too large.
  EXPECT_EQ(totals.switched, 0u);
  const double least = least_coverage(estimator.figures.coverage.lower, fits_per_material);
  const bench::Band pulls = pull_limits(estimator.figures);
  for (const bench::MaterialCoverage& material : materials) {
    for (const bench::ParameterCoverage& parameter : material.parameters) {
      EXPECT_GE(parameter.coverage, least) << material.material << " " << parameter.name;
      EXPECT_GE(parameter.pull, pulls.lower) << material.material << " " << parameter.name;
      EXPECT_LE(parameter.pull, pulls.upper) << material.material << " " << parameter.name;
    }
  }
  // The intervals of one fit may hold or miss together: a fit counts as one trial.
  const bench::Band pooled = estimator.figures.pooled_coverage;
  EXPECT_GE(totals.pooled_coverage, least_coverage(pooled.lower, totals.fits));
  EXPECT_LE(totals.pooled_coverage, largest_coverage(pooled.upper, totals.fits));
}

TEST(Coverage, WithKnownSigmaErrorsReachTheCramerRaoBoundAndIntervalsHoldTheTruth) {
  const bench::Estimator& estimator = bench::known_sigma;
  const std::vector<bench::MaterialCoverage> materials = study_all(estimator);
  expect_honest_intervals(estimator, materials);
  const double largest = *estimator.figures.largest_ratio * largest_rms(fits_per_material);
  for (const bench::MaterialCoverage& material : materials) {
    for (const bench::ParameterCoverage& parameter : material.parameters) {
      EXPECT_LE(parameter.ratio, largest) << material.material << " " << parameter.name;
    }
  }
  // The parameters of a material may err together: a fit counts as one error.
  const bench::CoverageTotals totals = bench::sum_up(materials);
  EXPECT_LE(totals.mean_ratio, *estimator.figures.largest_mean_ratio * largest_rms(totals.fits));
}

TEST(Coverage, WithoutKnowledgeOfTheNoiseTheSandwichHoldsTheTruth) {
  expect_honest_intervals(bench::noise_not_told, study_all(bench::noise_not_told));
}

TEST(Coverage, LimitsSeeWrongErrorBarsAndAnInefficientEstimate) {
  // Equal noise is assumed where it is 2 % of values between 0.03 and 6 / sr: rolled brass's rho_d
  // gets the noise of the lobe. Nor is an estimate efficient that does not know the noise.
  bench::Estimator naive = bench::noise_not_told;
  naive.covariance = naive.expected = fit::Covariance::residual;
  const bench::MaterialCoverage brass =
      study(instrument::read_recipe(GONIO_SOURCE_DIR "/data/synthetic/rolled_brass.json"), naive);
  const bench::ParameterCoverage& rho_d = brass.parameters.front();
  EXPECT_LT(rho_d.pull, pull_limits(naive.figures).lower);
  EXPECT_GT(rho_d.ratio,
            *bench::known_sigma.figures.largest_ratio * largest_rms(fits_per_material));
}

TEST(Coverage, StudyIsTheSameForAnyNumberOfThreads) {
  const instrument::Recipe recipe = recipes().front();
  const std::vector<double> bounds = bench::cramer_rao_bounds(recipe);
  const auto one = bench::study_coverage(recipe, bounds, bench::known_sigma, 7, 1);
  const auto three = bench::study_coverage(recipe, bounds, bench::known_sigma, 7, 3);
  for (std::size_t u = 0; u < one.parameters.size(); ++u) {
    EXPECT_EQ(three.parameters[u].bias, one.parameters[u].bias);
    EXPECT_EQ(three.parameters[u].ratio, one.parameters[u].ratio);
    EXPECT_EQ(three.parameters[u].coverage, one.parameters[u].coverage);
  }
}

/// The recipe's table with the true values in place of the readings, and the true sigma.
table::SampleTable table_without_noise(instrument::Recipe recipe) {
  recipe.sigma_columns = true;
  table::SampleTable table = instrument::synthesize(recipe);
  recipe.sigma_columns = false;
  recipe.noise = {};
  table.values = instrument::synthesize(recipe).values;
  return table;
}

/// The fit's (J'J)^-1 comes from derivatives in double precision, the bound from differences of a
/// plain formula in 50 digits; at the truth they are the same.
void expect_bounds_of_a_fit(const instrument::Recipe& recipe) {
  const fit::FitResult result =
      fit::fit(brdf::Model(recipe.model), table_without_noise(recipe),
               {.metric = fit::Metric::chi2, .covariance = fit::Covariance::known_sigma});
  const std::vector<double> bounds = bench::cramer_rao_bounds(recipe);
  ASSERT_EQ(bounds.size(), result.unknowns.size());
  for (std::size_t u = 0; u < bounds.size(); ++u) {
    ASSERT_TRUE(result.uncertainty.stddev[u].has_value());
    // The fit finds the truth to 1e-9 (fit_recovery_test.cpp), and the bound varies with it.
    EXPECT_NEAR(*result.uncertainty.stddev[u] / bounds[u], 1, 1e-8)
        << recipe.name << " " << recipe.model << " " << result.unknowns[u].name;
  }
}

TEST(CramerRaoBound, IsTheCovarianceOfAFitToTheTruth) {
  for (const instrument::Recipe& recipe : recipes()) expect_bounds_of_a_fit(recipe);
}

TEST(CramerRaoBound, IsTheCovarianceOfAFitForEveryWardLobeAndSeveralChannels) {
  for (const char* model : {"ward", "ward-aniso", "ward-approx", "ward-approx-aniso", "ward-duer",
                            "ward-duer-aniso", "ward-gmd", "ward-gmd-aniso"}) {
    instrument::Recipe recipe = ward_recipe(ward_materials[2], model);
    recipe.incidence_angles_deg = {25, 55};
    recipe.channels = {"R", "G"};
    recipe.parameters["rho_d"] = {0.15, 0.05};
    recipe.parameters["rho_s"] = {0.19, 0.30};
    recipe.noise = {.relative = 0.02, .floor = 1e-3};
    expect_bounds_of_a_fit(recipe);
  }
}

TEST(CramerRaoBound, RefusesWhatItCannotTell) {
  instrument::Recipe recipe = recipes().front();
  recipe.model = "lambert";
  recipe.parameters = {{"rho_d", {0.5}}};
  EXPECT_THROW(bench::cramer_rao_bounds(recipe), std::invalid_argument);
  recipe = recipes().front();
  recipe.parameters["psi"] = {0.1};
  EXPECT_THROW(bench::cramer_rao_bounds(recipe), std::invalid_argument);
  recipe = recipes().front();
  recipe.noise = {};
  EXPECT_THROW(bench::cramer_rao_bounds(recipe), std::invalid_argument);
}

}  // namespace
}  // namespace gonio::tests
