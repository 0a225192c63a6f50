// Fits with an unknown tangent angle, with two lobes, and with rho_s = 1 - rho_d.
#include <ceres/ceres.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "tests/plain_problem.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

using std::numbers::pi;

std::size_t index_of(const fit::FitResult& result, std::string_view name) {
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    if (result.unknowns[u].name == name) return u;
  }
  ADD_FAILURE() << "no unknown " << name;
  return 0;
}

double value_of(const fit::FitResult& result, std::string_view name) {
  return result.values[result.unknowns[index_of(result, name)]];
}

/// The difference of two tangent angles, which are the same half a turn apart.
double tangent_difference(double a, double b) { return std::abs(std::remainder(a - b, pi)); }

bool is_finite(const fit::FitResult& result) {
  bool finite = std::isfinite(result.cost) && result.uncertainty.covariance.allFinite() &&
                result.values.amplitudes.allFinite();
  for (const double x : result.values.shape) finite = finite && std::isfinite(x);
  for (const auto& stddev : result.uncertainty.stddev) {
    finite = finite && (!stddev || std::isfinite(*stddev));
  }
  return finite;
}

void expect_canonical(const fit::FitResult& result, const std::string& suffix = "") {
  EXPECT_LE(value_of(result, "alpha_x" + suffix), value_of(result, "alpha_y" + suffix));
  EXPECT_GE(value_of(result, "psi" + suffix), -pi / 2);
  EXPECT_LT(value_of(result, "psi" + suffix), pi / 2);
}

/// A brushed metal with its tangent at psi.
instrument::Recipe turned_recipe(double alpha_x, double alpha_y, double psi_deg) {
  WardMaterial material = ward_materials[0];
  material.alpha_x = alpha_x;
  material.alpha_y = alpha_y;
  instrument::Recipe recipe = ward_recipe(material, "ward-aniso");
  recipe.parameters["psi"] = {psi_deg * pi / 180};
  return recipe;
}

struct Turn {
  double alpha_x, alpha_y, psi_deg;

  /// The tangent angle of the description with alpha_x <= alpha_y.
  double canonical_psi() const { return (psi_deg + (alpha_x > alpha_y ? 90 : 0)) * pi / 180; }
};

class AFreeFrame : public testing::TestWithParam<Turn> {};

TEST_P(AFreeFrame, IsFoundCanonicallyWithoutNoise) {
  const Turn turn = GetParam();
  const table::SampleTable table =
      instrument::synthesize(turned_recipe(turn.alpha_x, turn.alpha_y, turn.psi_deg));
  const brdf::Model model("ward-aniso", brdf::Frame::free);
  for (const fit::Metric metric : {fit::Metric::l2, fit::Metric::cosine_l2, fit::Metric::log}) {
    const fit::FitResult result = fit::fit(model, table, {.metric = metric});
    EXPECT_TRUE(result.converged);
    expect_canonical(result);
    EXPECT_NEAR(value_of(result, "alpha_x"), std::min(turn.alpha_x, turn.alpha_y), 1e-10);
    EXPECT_NEAR(value_of(result, "alpha_y"), std::max(turn.alpha_x, turn.alpha_y), 1e-10);
    EXPECT_LE(tangent_difference(value_of(result, "psi"), turn.canonical_psi()), 1e-9);
    EXPECT_NEAR(value_of(result, "rho_s.Y"), 0.33, 1e-9);
  }
}

TEST_P(AFreeFrame, IsWithinItsIntervalsWithNoise) {
  const Turn turn = GetParam();
  instrument::Recipe recipe = turned_recipe(turn.alpha_x, turn.alpha_y, turn.psi_deg);
  recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = 5};
  const fit::FitResult result =
      fit::fit(brdf::Model("ward-aniso", brdf::Frame::free), instrument::synthesize(recipe), {});
  EXPECT_TRUE(result.converged);
  expect_canonical(result);
  // 99.9 % for all the 12 x 5 intervals of this suite together.
  const double quantile = 4.3;
  const auto error_in_stddevs = [&](std::string_view name, double error) {
    return error / *result.uncertainty.stddev[index_of(result, name)];
  };
  const double alpha_x = value_of(result, "alpha_x") - std::min(turn.alpha_x, turn.alpha_y);
  const double alpha_y = value_of(result, "alpha_y") - std::max(turn.alpha_x, turn.alpha_y);
  const double psi = tangent_difference(value_of(result, "psi"), turn.canonical_psi());
  EXPECT_LE(std::abs(error_in_stddevs("alpha_x", alpha_x)), quantile);
  EXPECT_LE(std::abs(error_in_stddevs("alpha_y", alpha_y)), quantile);
  EXPECT_LE(error_in_stddevs("psi", psi), quantile);
  EXPECT_LE(std::abs(error_in_stddevs("rho_d.Y", value_of(result, "rho_d.Y") - 0.1)), quantile);
  EXPECT_LE(std::abs(error_in_stddevs("rho_s.Y", value_of(result, "rho_s.Y") - 0.33)), quantile);
  EXPECT_LT(*result.uncertainty.stddev[index_of(result, "psi")], 0.01);
}

INSTANTIATE_TEST_SUITE_P(EveryTurn, AFreeFrame,
                         testing::Values(Turn{0.05, 0.16, -80}, Turn{0.05, 0.16, -40},
                                         Turn{0.05, 0.16, -5}, Turn{0.05, 0.16, 0},
                                         Turn{0.05, 0.16, 30}, Turn{0.05, 0.16, 80},
                                         Turn{0.16, 0.05, -80}, Turn{0.16, 0.05, -40},
                                         Turn{0.16, 0.05, 0}, Turn{0.16, 0.05, 5},
                                         Turn{0.16, 0.05, 30}, Turn{0.16, 0.05, 80}));

TEST(AnIsotropicLobeInAFreeFrame, HasATangentThatIsHardlyDetermined) {
  for (const double alpha_y : {0.1, 0.1001, 0.103}) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      instrument::Recipe recipe = turned_recipe(0.1, alpha_y, 25);
      recipe.noise = {.relative = 0.05, .floor = 5e-3, .seed = seed};
      const fit::FitResult result = fit::fit(brdf::Model("ward-aniso", brdf::Frame::free),
                                             instrument::synthesize(recipe), {});
      EXPECT_TRUE(is_finite(result)) << alpha_y << " seed " << seed;
      expect_canonical(result);
      // A difference of 3 % is many standard deviations; 0.1 % is none.
      const auto& stddev = result.uncertainty.stddev[index_of(result, "psi")];
      EXPECT_TRUE(alpha_y > 0.102 || !stddev || *stddev > 0.05) << alpha_y << " seed " << seed;
    }
  }
}

TEST(AnIsotropicLobeInAFreeFrame, WithoutNoiseIsFoundAllTheSame) {
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso", brdf::Frame::free),
                                         instrument::synthesize(turned_recipe(0.1, 0.1, 25)), {});
  EXPECT_TRUE(is_finite(result));
  expect_canonical(result);
  EXPECT_NEAR(value_of(result, "alpha_x"), 0.1, 1e-9);
  EXPECT_NEAR(value_of(result, "alpha_y"), 0.1, 1e-9);
  EXPECT_FALSE(result.uncertainty.stddev[index_of(result, "psi")].has_value())
      << "no direction sees the tangent of an isotropic lobe";
}

TEST(AFixedTangent, StaysAndTheRoughnessesAreNotSwapped) {
  const table::SampleTable table = instrument::synthesize(turned_recipe(0.16, 0.05, 30));
  const fit::FitResult result =
      fit::fit(brdf::Model("ward-aniso", brdf::Frame::free), table, {.fixed = {{"psi", pi / 6}}});
  EXPECT_EQ(value_of(result, "psi"), pi / 6);
  EXPECT_NEAR(value_of(result, "alpha_x"), 0.16, 1e-10);
  EXPECT_NEAR(value_of(result, "alpha_y"), 0.05, 1e-10);
}

// Two lobes.

instrument::Recipe two_lobe_recipe(double first, double second) {
  instrument::Recipe recipe = ward_recipe(ward_materials[8], "lambert+ward+ward");
  recipe.parameters = {{"rho_d", {0.2}},
                       {"rho_s", {0.1}},
                       {"alpha", {first}},
                       {"rho_s_2", {0.3}},
                       {"alpha_2", {second}}};
  return recipe;
}

TEST(TwoLobes, AreFoundTheNarrowOneFirst) {
  // Whichever the table's author called the first.
  const brdf::Model model("lambert+ward+ward");
  for (const bool narrow_first : {true, false}) {
    const table::SampleTable table = instrument::synthesize(
        narrow_first ? two_lobe_recipe(0.06, 0.3) : two_lobe_recipe(0.3, 0.06));
    const fit::FitResult result = fit::fit(model, table, {});
    EXPECT_TRUE(result.converged);
    EXPECT_NEAR(value_of(result, "alpha"), 0.06, 1e-9);
    EXPECT_NEAR(value_of(result, "alpha_2"), 0.3, 1e-8);
    EXPECT_NEAR(value_of(result, "rho_s.Y"), narrow_first ? 0.1 : 0.3, 1e-8);
    EXPECT_NEAR(value_of(result, "rho_s_2.Y"), narrow_first ? 0.3 : 0.1, 1e-8);
    EXPECT_NEAR(value_of(result, "rho_d.Y"), 0.2, 1e-8);
  }
}

TEST(TwoLobes, AreInOrderWithNoiseToo) {
  const brdf::Model model("lambert+ward+ward");
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    instrument::Recipe recipe = two_lobe_recipe(0.2, 0.08);
    recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = seed};
    const fit::FitResult result = fit::fit(model, instrument::synthesize(recipe), {});
    EXPECT_TRUE(result.converged);
    const double narrow = value_of(result, "alpha");
    const double wide = value_of(result, "alpha_2");
    EXPECT_LT(narrow, wide);
    // 99.9 % over the 10 intervals together.
    EXPECT_NEAR(narrow, 0.08, 3.9 * *result.uncertainty.stddev[index_of(result, "alpha")]);
    EXPECT_NEAR(wide, 0.2, 3.9 * *result.uncertainty.stddev[index_of(result, "alpha_2")]);
  }
}

TEST(TwoLobes, OneOfThemAnisotropicAndTurnedAreFound) {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "lambert+ward+ward-aniso");
  recipe.parameters = {{"rho_d", {0.2}},          {"rho_s", {0.1}},      {"alpha", {0.3}},
                       {"rho_s_2", {0.3}},        {"alpha_x_2", {0.14}}, {"alpha_y_2", {0.05}},
                       {"psi_2", {20 * pi / 180}}};
  const fit::FitResult result = fit::fit(brdf::Model("lambert+ward+ward-aniso", brdf::Frame::free),
                                         instrument::synthesize(recipe), {});
  EXPECT_TRUE(result.converged);
  expect_canonical(result, "_2");
  EXPECT_NEAR(value_of(result, "alpha"), 0.3, 1e-8);
  EXPECT_NEAR(value_of(result, "alpha_x_2"), 0.05, 1e-9);
  EXPECT_NEAR(value_of(result, "alpha_y_2"), 0.14, 1e-9);
  EXPECT_LE(tangent_difference(value_of(result, "psi_2"), 110 * pi / 180), 1e-8);
  EXPECT_NEAR(value_of(result, "rho_s_2.Y"), 0.3, 1e-8);
}

// rho_s = 1 - rho_d.

/// A material that absorbs, so that the constraint is not met by itself.
table::SampleTable absorbing_table() {
  instrument::Recipe recipe = ward_recipe(ward_materials[1], "ward-aniso");
  recipe.channels = {"R", "G"};
  recipe.parameters["rho_d"] = {0.45, 0.3};
  recipe.parameters["rho_s"] = {0.4, 0.6};
  recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = 6};
  return instrument::synthesize(recipe);
}

struct HomogeneousResidual {
  PlainValue value;
  template <class S>
  bool operator()(const S* rho_d, const S* shape, S* residual) const {
    const S lobe = plain_ward(shape[0], shape[1], S(0), value.wi, value.wo);
    *residual = plain_residual(fit::Metric::cosine_l2, value.f,
                               rho_d[0] / pi + (1.0 - rho_d[0]) * lobe, value.wi.z, 0, 1);
    return true;
  }
};

TEST(AHomogeneousMaterial, IsTheConstrainedMinimum) {
  const table::SampleTable table = absorbing_table();
  const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), table, {.homogeneous = true});
  EXPECT_TRUE(result.converged);

  std::array<double, 2> rho_d{0.45, 0.3};
  std::array<double, 2> shape{0.04, 0.09};
  ceres::Problem problem;
  for (const PlainValue& value : plain_values(table, {0, 0})) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<HomogeneousResidual, 1, 1, 2>(
                                 new HomogeneousResidual{value}),
                             nullptr, &rho_d[value.channel], shape.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.function_tolerance = options.gradient_tolerance = 1e-18;
  options.parameter_tolerance = 1e-13;
  options.max_num_iterations = 500;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  EXPECT_NEAR(result.cost, summary.final_cost, 1e-10 * summary.final_cost);
  EXPECT_NEAR(value_of(result, "alpha_x") / shape[0], 1, 1e-7);
  EXPECT_NEAR(value_of(result, "alpha_y") / shape[1], 1, 1e-7);
  EXPECT_NEAR(value_of(result, "rho_d.R") / rho_d[0], 1, 1e-7);
  EXPECT_NEAR(value_of(result, "rho_d.G") / rho_d[1], 1, 1e-7);
}

TEST(AHomogeneousMaterial, HasOneAlbedoThatTheOtherFollowsFrom) {
  for (const fit::Metric metric :
       {fit::Metric::cosine_l2, fit::Metric::log, fit::Metric::cube_root}) {
    for (const fit::Loss loss : {fit::Loss::none, fit::Loss::cauchy}) {
      const fit::FitResult result = fit::fit(brdf::Model("ward-aniso"), absorbing_table(),
                                             {.metric = metric, .loss = loss, .homogeneous = true});
      for (const std::string channel : {"R", "G"}) {
        const std::size_t d = index_of(result, "rho_d." + channel);
        const std::size_t s = index_of(result, "rho_s." + channel);
        EXPECT_EQ(result.values[result.unknowns[s]], 1 - result.values[result.unknowns[d]]);
        EXPECT_TRUE(result.unknowns[s].dependent);
        EXPECT_FALSE(result.unknowns[d].dependent);
        EXPECT_NEAR(*result.uncertainty.stddev[s], *result.uncertainty.stddev[d],
                    1e-9 * *result.uncertainty.stddev[d]);
        EXPECT_NEAR(*result.uncertainty.correlation[d][s], -1, 1e-9);
      }
    }
  }
}

TEST(AHomogeneousMaterial, KeepsToTheBoundsOfBothAlbedos) {
  const table::SampleTable table = absorbing_table();
  const brdf::Model model("ward-aniso");
  const fit::FitResult fixed_d =
      fit::fit(model, table, {.fixed = {{"rho_d.R", 0.25}}, .homogeneous = true});
  EXPECT_EQ(value_of(fixed_d, "rho_d.R"), 0.25);
  EXPECT_EQ(value_of(fixed_d, "rho_s.R"), 0.75);
  const fit::FitResult fixed_s =
      fit::fit(model, table, {.fixed = {{"rho_s", 0.25}}, .homogeneous = true});
  EXPECT_EQ(value_of(fixed_s, "rho_d.R"), 0.75);
  EXPECT_EQ(value_of(fixed_s, "rho_s.G"), 0.25);
  const fit::FitResult bounded =
      fit::fit(model, table, {.bounds = {{"rho_s", 0.9, 0.95}}, .homogeneous = true});
  EXPECT_NEAR(value_of(bounded, "rho_s.R"), 0.9, 1e-15) << "the bound nearest to the data";
  EXPECT_NEAR(value_of(bounded, "rho_d.R"), 0.1, 1e-15);
  EXPECT_THROW(
      fit::fit(model, table,
               {.bounds = {{"rho_s", 0.1, 0.2}, {"rho_d", 0.1, 0.2}}, .homogeneous = true}),
      std::invalid_argument);
  EXPECT_THROW(fit::fit(brdf::Model("lambert"), table, {.homogeneous = true}),
               std::invalid_argument);
}

}  // namespace
}  // namespace gonio::tests
