// Every metric under every loss: the fit ends at the minimum that another solver finds from the
// truth, and reports the errors that a plain loop computes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "tests/every_metric.h"
#include "tests/plain_minimum.h"
#include "tests/plain_problem.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

/// Rolled brass in two channels with 2 % + 1e-3 noise; 1 % of the readings are spoilt by a factor
/// of 3 or 1/3. Weights and holes too.
table::SampleTable noisy_brass() {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "ward-aniso");
  recipe.channels = {"R", "G"};
  recipe.parameters["rho_d"] = {0.1, 0.2};
  recipe.parameters["rho_s"] = {0.33, 0.25};
  recipe.incidence_angles_deg = {15, 45, 65};
  recipe.sample_rotations_deg = {0, 40, 90};
  recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = 21};
  recipe.sigma_columns = true;
  table::SampleTable table = instrument::synthesize(recipe);
  std::mt19937_64 random(8);
  for (std::size_t i = 0; i < table.size(); ++i) {
    table.weight.push_back(0.5 + double(random() % 1000) / 1000);
    if (i % 29 == 0) table.values[1][i] = std::nan("");
    if (random() % 100 == 0) table.values[0][i] *= random() % 2 == 0 ? 3.0 : 1 / 3.0;
  }
  return table;
}

const PlainParameters truth{{0.1, 0.2}, {0.33, 0.25}, 0.05, 0.16};

/// Four standard deviations of the residuals, as their median tells it, at the truth.
double scale_for(const std::vector<PlainValue>& values, fit::Metric metric) {
  std::vector<double> magnitudes;
  for (const PlainValue& value : values) {
    magnitudes.push_back(std::abs(double(value.residual(metric, truth))));
  }
  return 4 * 1.4826 * plain_median(magnitudes);
}

class AFitUnder : public testing::TestWithParam<std::tuple<fit::Metric, fit::Loss>> {
 protected:
  AFitUnder() {
    if (loss != fit::Loss::none) options.loss_scale = scale_for(all_values, metric);
  }

  fit::Metric metric = std::get<0>(GetParam());
  fit::Loss loss = std::get<1>(GetParam());
  table::SampleTable measured = noisy_brass();
  std::vector<PlainValue> all_values =
      plain_values(measured, fit::relative_floors(measured, table::SampleFilter(measured, 80), 1));
  fit::Options options{.metric = metric, .loss = loss};
};

TEST_P(AFitUnder, EndsAtTheMinimumThatAnotherSolverFindsFromTheTruth) {
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), measured, options);
  EXPECT_TRUE(result.converged);
  const double scale = options.loss_scale.value_or(1);
  const PlainMinimum other = plain_minimum(all_values, metric, loss, scale, truth);
  ASSERT_TRUE(other.converged);
  const PlainParameters found = plain(result.values);
  // Sums of 3,000 values in double, in another order.
  const double rounding = 1e-10;
  EXPECT_NEAR(double(plain_cost(all_values, metric, loss, scale, found)), result.cost,
              rounding * result.cost);
  EXPECT_LE(result.cost, other.cost * (1 + rounding));
  const auto agree = [](long double a, long double b) { return std::abs(double(a / b - 1)); };
  EXPECT_LE(agree(found.alpha_x, other.parameters.alpha_x), 1e-6);
  EXPECT_LE(agree(found.alpha_y, other.parameters.alpha_y), 1e-6);
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_LE(agree(found.rho_d[c], other.parameters.rho_d[c]), 1e-6);
    EXPECT_LE(agree(found.rho_s[c], other.parameters.rho_s[c]), 1e-6);
  }
  RecordProperty("passes", result.passes);
}

TEST_P(AFitUnder, ReportsTheErrorsOfAPlainLoop) {
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), measured, options);
  const PlainParameters p = plain(result.values);
  const auto error_under = [&](fit::Metric reported) {
    long double squares = 0;
    long double weights = 0;
    for (const PlainValue& value : all_values) {
      squares += value.weight * std::pow(value.residual(reported, p), 2);
      weights += value.weight;
    }
    return double(std::sqrt(squares / weights));
  };
  ASSERT_EQ(result.errors.size(), 5u);
  for (const auto& [name, error] : result.errors) {
    const double expected = error_under(fit::metric_from_name(name));
    EXPECT_NEAR(error, expected, 1e-10 * expected) << name;
  }
  if (loss == fit::Loss::none) {
    const double expected = error_under(metric);
    EXPECT_NEAR(result.metric_error, expected, 1e-10 * expected);
  }
}

TEST_P(AFitUnder, HasTheSameBitsForAnyNumberOfThreads) {
  options.loss_scale.reset();  // found: more passes
  std::vector<fit::FitResult> results;
  for (const int threads : {1, 2, 7}) {
    options.threads = threads;
    results.push_back(fit::fit(brdf::Model("ward-aniso"), measured, options));
  }
  for (const fit::FitResult& other : results) {
    EXPECT_EQ(other.values.shape, results.front().values.shape);
    EXPECT_EQ(other.values.amplitudes, results.front().values.amplitudes);
    EXPECT_EQ(other.cost, results.front().cost);
    EXPECT_EQ(other.loss_scale, results.front().loss_scale);
    EXPECT_EQ(other.uncertainty.covariance, results.front().uncertainty.covariance);
    EXPECT_EQ(other.errors, results.front().errors);
    EXPECT_EQ(other.outlier_count, results.front().outlier_count);
    EXPECT_EQ(other.iterations, results.front().iterations);
    EXPECT_EQ(other.passes, results.front().passes);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, AFitUnder,
                         testing::Combine(testing::ValuesIn(all_metrics),
                                          testing::ValuesIn(all_losses)),
                         [](const auto& instance) { return name_of(instance); });

TEST(RelativeFloors, AreOnePerCentOfTheMedianMagnitudeThatIsNotZero) {
  table::SampleTable table = noisy_brass();
  for (std::size_t i = 0; i < table.size(); i += 3) table.values[0][i] = 0;
  const std::vector<double> floors = fit::relative_floors(table, table::SampleFilter(table, 80), 1);
  const std::vector<double> expected = plain_floors(table);
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_NEAR(floors[c], expected[c], 1e-4 * expected[c]);  // what survey.cpp searches to
  }
}

}  // namespace
}  // namespace gonio::tests
