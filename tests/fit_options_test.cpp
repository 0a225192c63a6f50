// What a user asks of a fit is what happens, and what cannot be is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "fit/fit.h"
#include "fit/ranking.h"
#include "instrument/synthesize.h"
#include "table/file_error.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

using testing::Contains;
using testing::HasSubstr;

table::SampleTable noisy_brass() {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "ward-aniso");
  recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = 5};
  return instrument::synthesize(recipe);
}

double value_of(const fit::FitResult& result, const std::string& name) {
  for (const fit::Unknown& unknown : result.unknowns) {
    if (unknown.name == name) return result.values[unknown];
  }
  ADD_FAILURE() << "no parameter " << name;
  return NAN;
}

std::size_t index_of(const fit::FitResult& result, const std::string& name) {
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    if (result.unknowns[u].name == name) return u;
  }
  ADD_FAILURE() << "no parameter " << name;
  return 0;
}

TEST(FixedParameters, StayAndHaveNoUncertainty) {
  const table::SampleTable table = noisy_brass();
  const fit::FitResult result =
      fit::fit(brdf::Model("ward-aniso"), table, {.fixed = {{"alpha_y", 0.2}, {"rho_d.Y", 0.05}}});
  EXPECT_EQ(value_of(result, "alpha_y"), 0.2);
  EXPECT_EQ(value_of(result, "rho_d.Y"), 0.05);
  EXPECT_FALSE(result.uncertainty.stddev[index_of(result, "alpha_y")].has_value());
  EXPECT_FALSE(result.uncertainty.stddev[index_of(result, "rho_d.Y")].has_value());
  EXPECT_TRUE(result.uncertainty.stddev[index_of(result, "alpha_x")].has_value());
  const fit::FitResult free = fit::fit(brdf::Model("ward-aniso"), table, {});
  EXPECT_GT(result.cost, free.cost);
}

TEST(FixedParameters, MayBeAllOfTheShape) {
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), noisy_brass(),
                                         {.fixed = {{"alpha_x", 0.05}, {"alpha_y", 0.16}}});
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(value_of(result, "rho_s.Y"), 0.33, 0.01);  // 3 %, a dozen standard deviations
}

TEST(Bounds, HoldAndAreWarnedOf) {
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), noisy_brass(),
                                         {.bounds = {{"alpha_x", 0.07, 0.5}, {"rho_d", 0, 0.08}}});
  EXPECT_NEAR(value_of(result, "alpha_x"), 0.07, 1e-6);
  EXPECT_GE(value_of(result, "alpha_x"), 0.07);
  EXPECT_LE(value_of(result, "rho_d.Y"), 0.08);
  EXPECT_THAT(result.warnings, Contains(HasSubstr("alpha_x ends at its lower bound")));
}

TEST(Bounds, LeaveTheOtherParametersAtTheirBestAsIfFixedThere) {
  const table::SampleTable table = noisy_brass();
  for (const auto& [name, low, high, at] :
       {std::tuple{"alpha_x", 0.1, 1.0, 0.1}, std::tuple{"alpha_y", 0.3, 0.5, 0.3},
        std::tuple{"alpha_y", 0.01, 0.1, 0.1}}) {
    const fit::FitResult bounded =
        fit::fit(brdf::Model("ward-aniso"), table, {.bounds = {{name, low, high}}});
    const fit::FitResult fixed =
        fit::fit(brdf::Model("ward-aniso"), table, {.fixed = {{name, at}}});
    EXPECT_TRUE(bounded.converged);
    EXPECT_LE(bounded.cost, fixed.cost * (1 + 1e-9)) << name << " " << low << ":" << high;
  }
}

TEST(Bounds, ThatEndInsideTheBoxDoNoHarm) {
  const table::SampleTable table = noisy_brass();
  const fit::FitResult free = fit::fit(brdf::Model("ward-aniso"), table, {});
  const fit::FitResult bounded =
      fit::fit(brdf::Model("ward-aniso"), table,
               {.start = {{"alpha_x", 0.3}, {"alpha_y", 0.3}},
                .bounds = {{"alpha_x", 0.01, 0.3}, {"alpha_y", 0.05, 0.3}}});
  EXPECT_LE(bounded.cost, free.cost * (1 + 1e-9));
}

TEST(AStartValue, ReplacesTheSearch) {
  const table::SampleTable table = noisy_brass();
  const fit::FitResult searched = fit::fit(brdf::Model("ward-aniso"), table, {});
  const fit::FitResult started =
      fit::fit(brdf::Model("ward-aniso"), table, {.start = {{"alpha_x", 0.06}, {"alpha_y", 0.12}}});
  // Both stop at the same minimum, each to the solver's step tolerance.
  EXPECT_NEAR(value_of(started, "alpha_x"), value_of(searched, "alpha_x"), 1e-8);
  EXPECT_NEAR(value_of(started, "alpha_y"), value_of(searched, "alpha_y"), 1e-8);
}

TEST(MaxTheta, LeavesOutBothAnglesBeyondItAndIsInclusive) {
  const table::SampleTable table = noisy_brass();
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), table, {.max_theta_deg = 55});
  std::size_t within = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double theta_i = std::acos(table.wi.z[i]) * 180 / M_PI;
    const double theta_o = std::acos(table.wo.z[i]) * 180 / M_PI;
    if (theta_i < 55.0000005 && theta_o < 55.0000005) ++within;
  }
  EXPECT_EQ(result.used, within);
  EXPECT_LT(within, table.size());
}

TEST(ARefusal, NamesWhatIsWrong) {
  const table::SampleTable table = noisy_brass();
  const auto message_of = [&](std::string_view model, const fit::Options& options) {
    try {
      fit::fit(brdf::Model(model), table, options);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  EXPECT_THAT(message_of("ward", {.fixed = {{"alpha_x", 1}}}), HasSubstr("alpha_x"));
  EXPECT_THAT(message_of("ward", {.fixed = {{"alpha", 11}}}), HasSubstr("outside the bounds"));
  EXPECT_THAT(message_of("ward", {.fixed = {{"rho_d.R", 1}}}), HasSubstr("rho_d.Y"));
  EXPECT_THAT(message_of("ward", {.bounds = {{"alpha", 20, 30}}}), HasSubstr("leave nothing"));
  EXPECT_THAT(message_of("ward", {.metric = fit::Metric::chi2}), HasSubstr("--noise"));
}

TEST(ATableWithFewerValuesThanUnknowns, IsRefused) {
  table::SampleTable table = noisy_brass();
  for (std::size_t i = 3; i < table.size(); ++i) table.mask[i] = table::MaskReason::hole;
  EXPECT_THROW(fit::fit(brdf::Model("ward-aniso"), table, {}), table::FileError);
  EXPECT_NO_THROW(fit::fit(brdf::Model("lambert"), table, {}));
}

TEST(ATableWithoutValidSamples, IsRefusedWithTheReasons) {
  table::SampleTable table = noisy_brass();
  for (table::MaskReason& reason : table.mask) reason = table::MaskReason::extrapolated;
  try {
    fit::fit(brdf::Model("lambert"), table, {});
    FAIL() << "not refused";
  } catch (const table::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("extrapolated"));
  }
}

TEST(AHoleInOneChannel, LeavesTheOthersInUse) {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "ward-aniso");
  recipe.channels = {"R", "G"};
  recipe.parameters["rho_d"] = {0.1, 0.2};
  recipe.parameters["rho_s"] = {0.33, 0.3};
  table::SampleTable table = instrument::synthesize(recipe);
  for (std::size_t i = 0; i < table.size(); i += 3) {
    table.values[0][i] = std::numeric_limits<double>::quiet_NaN();
  }
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), table, {});
  EXPECT_NEAR(value_of(result, "rho_d.R"), 0.1, 1e-9);
  EXPECT_NEAR(value_of(result, "rho_s.G"), 0.3, 1e-9);
  EXPECT_NEAR(value_of(result, "alpha_y"), 0.16, 1e-9);
}

TEST(Weights, CountLikeRepeatedSamples) {
  table::SampleTable weighted = noisy_brass();
  table::SampleTable repeated = weighted;
  weighted.weight.assign(weighted.size(), 1);
  for (std::size_t i = 0; i < weighted.size(); i += 2) {
    weighted.weight[i] = 3;
    for (int copy = 0; copy < 2; ++copy) {
      repeated.wi.push_back(weighted.wi[i]);
      repeated.wo.push_back(weighted.wo[i]);
      repeated.values[0].push_back(weighted.values[0][i]);
      repeated.mask.push_back(weighted.mask[i]);
    }
  }
  const fit::FitResult a = fit::fit(brdf::Model("ward-aniso"), weighted, {});
  const fit::FitResult b = fit::fit(brdf::Model("ward-aniso"), repeated, {});
  EXPECT_NEAR(a.cost, b.cost, 1e-12 * b.cost);
  EXPECT_NEAR(value_of(a, "alpha_x"), value_of(b, "alpha_x"), 1e-8);
  for (std::size_t m = 0; m < a.errors.size(); ++m) {
    EXPECT_NEAR(a.errors[m].second, b.errors[m].second, 1e-6 * b.errors[m].second)
        << a.errors[m].first;
  }
}

TEST(SamplesOfWeightZero, TakeNoPart) {
  table::SampleTable weighted = noisy_brass();
  table::SampleTable without = weighted;
  weighted.weight.assign(weighted.size(), 1);
  without.weight.assign(without.size(), 1);
  for (std::size_t i = 0; i < weighted.size(); i += 2) {
    weighted.weight[i] = 0;
    without.mask[i] = table::MaskReason::hole;
  }
  const fit::FitResult a = fit::fit(brdf::Model("ward-aniso"), weighted, {});
  const fit::FitResult b = fit::fit(brdf::Model("ward-aniso"), without, {});
  EXPECT_EQ(a.used, b.used);
  EXPECT_EQ(a.uncertainty.stddev, b.uncertainty.stddev);
  weighted.weight.assign(weighted.size(), 0);
  EXPECT_THROW(fit::fit(brdf::Model("lambert"), weighted, {}), table::FileError);
}

TEST(ErrorsOfAFit, AreFiniteWhereAnInstrumentReadZeroMostly) {
  table::SampleTable table = noisy_brass();
  for (double& value : table.values[0]) value = value < 0.05 ? 0 : value;
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), table, {});
  for (const auto& [metric, error] : result.errors) EXPECT_TRUE(std::isfinite(error)) << metric;
}

TEST(ErrorsOfAFit, AreTheRootMeanSquaresOfTheirDefinition) {
  const table::SampleTable table = noisy_brass();
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), table, {});
  std::vector<double> magnitudes;
  for (const double value : table.values[0]) magnitudes.push_back(std::abs(value));
  std::nth_element(magnitudes.begin(), magnitudes.begin() + std::ptrdiff_t(table.size() - 1) / 2,
                   magnitudes.end());
  const double floor = 0.01 * magnitudes[(table.size() - 1) / 2];
  std::array<double, 5> squares{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double f = table.values[0][i];
    const double c = table.wi.z[i];
    const double amplitudes[] = {result.values.amplitudes(0, 0), result.values.amplitudes(1, 0)};
    const double m =
        result.model.evaluate(amplitudes, result.values.shape, table.wi[i], table.wo[i]);
    const auto square = [](double x) { return x * x; };
    squares[0] += square(f - m);
    squares[1] += square((f - m) * c);
    squares[2] += square(std::log(1 + std::max(0.0, f * c)) - std::log(1 + m * c));
    squares[3] += square(std::cbrt(std::max(0.0, f * c)) - std::cbrt(m * c));
    squares[4] += square((f - m) / std::max(std::abs(f), floor));
  }
  for (std::size_t m = 0; m < squares.size(); ++m) {
    const double expected = std::sqrt(squares[m] / double(table.size()));
    EXPECT_NEAR(result.errors[m].second, expected, 1e-10 * expected) << result.errors[m].first;
  }
}

TEST(ValuesThatNoMaterialHas, AreRefused) {
  table::SampleTable table = noisy_brass();
  for (double& value : table.values[0]) value *= 1e200;
  EXPECT_THROW(fit::fit(brdf::Model("ward-aniso"), table, {}), table::FileError);
}

TEST(Warnings, SayThatInPlaneDirectionsCannotTellTheRoughnessesApart) {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "ward-aniso");
  recipe.sample_rotations_deg = {0};
  recipe.hemisphere = {.theta_step_deg = 5, .phi_step_deg = 180};  // the plane of incidence alone
  recipe.mirror_patch.reset();
  const table::SampleTable table = instrument::synthesize(recipe);
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), table, {});
  EXPECT_THAT(result.warnings, Contains(HasSubstr("alpha_x cannot be told against alpha_y")));
  EXPECT_FALSE(result.uncertainty.stddev[index_of(result, "alpha_y")].has_value());
  EXPECT_TRUE(result.uncertainty.stddev[index_of(result, "alpha_x")].has_value());
  EXPECT_NEAR(value_of(result, "alpha_x"), 0.05, 1e-6);

  std::vector<std::string> excluded;
  const std::vector<std::string> models = fit::determinable_models(table, {}, excluded);
  EXPECT_THAT(models, Contains("lambert+ward"));
  EXPECT_THAT(models, testing::Not(Contains("lambert+ward-aniso")));
  EXPECT_THAT(excluded, Contains(HasSubstr("alpha_y")));
}

TEST(Warnings, SayThatRoughnessMeansNothingWithoutALobe) {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "lambert");
  recipe.parameters = {{"rho_d", {0.5}}};
  recipe.noise = {.relative = 0, .floor = 0, .seed = 1};
  const fit::FitResult result =
      fit::fit(brdf::Model("ward-aniso"), instrument::synthesize(recipe), {});
  EXPECT_NEAR(value_of(result, "rho_d.Y"), 0.5, 1e-9);
  EXPECT_NEAR(value_of(result, "rho_s.Y"), 0, 1e-9);
  EXPECT_THAT(result.warnings, Contains(HasSubstr("means nothing")));
  EXPECT_FALSE(result.uncertainty.stddev[index_of(result, "alpha_x")].has_value());
  EXPECT_FALSE(result.uncertainty.stddev[index_of(result, "alpha_y")].has_value());
}

TEST(Warnings, SayThatALobeMayBeNoise) {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "lambert");
  recipe.parameters = {{"rho_d", {0.5}}};
  recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = 1};
  const fit::FitResult result = fit::fit(brdf::Model("ward"), instrument::synthesize(recipe), {});
  EXPECT_THAT(result.warnings, Contains(testing::AnyOf(HasSubstr("cannot be told from 0"),
                                                       HasSubstr("means nothing"))));
}

TEST(Warnings, SayThatNothingIsLeftToTellTheUncertaintyFrom) {
  table::SampleTable table = noisy_brass();
  for (std::size_t i = 1; i < table.size(); ++i) table.mask[i] = table::MaskReason::hole;
  const fit::FitResult result = fit::fit(brdf::Model("lambert"), table, {});
  EXPECT_THAT(result.warnings, Contains(HasSubstr("nothing is left")));
}

TEST(Warnings, SayThatMoreLightLeavesThanArrives) {
  instrument::Recipe recipe = ward_recipe(ward_materials[6], "ward");
  recipe.parameters["rho_s"] = {0.4};
  const fit::FitResult result = fit::fit(brdf::Model("ward"), instrument::synthesize(recipe), {});
  EXPECT_THAT(result.warnings, Contains(HasSubstr("over 1")));
}

TEST(Ranking, PutsTheTrueModelFirstOfTheNoiseFree) {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "ward-duer-aniso");
  const table::SampleTable table = instrument::synthesize(recipe);
  std::vector<std::string> excluded;
  std::vector<fit::FitResult> results;
  for (const std::string& name : fit::determinable_models(table, {}, excluded)) {
    results.push_back(fit::fit(brdf::Model(name), table, {}));
  }
  EXPECT_EQ(results.size(), brdf::model_names().size());
  EXPECT_TRUE(excluded.empty());
  const auto best = std::min_element(results.begin(), results.end(), fit::ranks_before);
  EXPECT_EQ(best->model.name(), "lambert+ward-duer-aniso");
}

}  // namespace
}  // namespace gonio::tests
