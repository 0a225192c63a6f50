// What `gonio albedo` prints, for people and for programs, and the warning of a fit whose model
// reflects more than arrives.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <numbers>

#include "brdf/albedo.h"
#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "tests/run_gonio.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double radians_per_degree = std::numbers::pi / 180;

/// Duer's lobe: with rho_s = 0.8 of G its albedo at 85 deg is 0.2 + 0.8 * 1.252 = 1.202.
constexpr std::string_view duer = R"({
  "format": "gonio-material", "version": 1, "name": "duer", "model": "ward-duer",
  "channels": ["R", "G"],
  "parameters": {"rho_d": {"value": [0.1, 0.2]}, "rho_s": {"value": [0.3, 0.8]},
                 "alpha": {"value": 0.3}}})";

constexpr std::string_view brushed = R"({
  "format": "gonio-material", "version": 1, "model": "ward-gmd-aniso", "channels": ["Y"],
  "parameters": {"rho_d": {"value": [0.1]}, "rho_s": {"value": [0.3]},
                 "alpha_x": {"value": 0.05}, "alpha_y": {"value": 0.4}}})";

TEST(AlbedoCommand, ListsAnglesByChannelsAndMarksThoseOverOne) {
  const TemporaryFolder folder;
  const auto result = run_gonio({"albedo", folder.write("duer.json", duer)});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  // Every angle of the default, in order; 1.20196 is marked, 0.475734 is not.
  EXPECT_THAT(result.out, HasSubstr("lambert+ward-duer"));
  EXPECT_THAT(result.out, HasSubstr("\n     85    0.475734      1.20196*\n"));
  EXPECT_THAT(result.out, HasSubstr("\n     89     1.38846*     3.63589*\n"));
  for (const char* angle : {"\n      0 ", "\n     30 ", "\n     60 ", "\n     75 "}) {
    EXPECT_THAT(result.out, HasSubstr(angle));
  }
  EXPECT_THAT(result.out, HasSubstr("* over 1: for light from 85, 89 deg"));
}

TEST(AlbedoCommand, SaysThatNothingIsOverOne) {
  const TemporaryFolder folder;
  const auto result =
      run_gonio({"albedo", folder.write("duer.json", duer), "--theta", "0,12.5,80"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("   12.5 "), Not(HasSubstr("*")),
                                HasSubstr("At none of these angles")));
}

TEST(AlbedoCommand, TellsProgramsEveryDigitWithItsError) {
  const TemporaryFolder folder;
  const auto result = run_gonio({"albedo", folder.write("brushed.json", brushed), "--theta",
                                 "30,80", "--phi", "40", "--tolerance", "1e-8", "--json"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["model"], "lambert+ward-gmd-aniso");
  EXPECT_EQ(json["channels"], (nlohmann::json{"Y"}));
  EXPECT_EQ(json["phi_deg"], 40);
  EXPECT_EQ(json["tolerance"], 1e-8);
  ASSERT_EQ(json["angles"].size(), 2U);
  const brdf::Albedo basis =
      brdf::basis_albedo(brdf::Model("ward-gmd-aniso"), std::array{0.05, 0.4},
                         80 * radians_per_degree, 40 * radians_per_degree, 1e-8);
  const auto& row = json["angles"][1];
  EXPECT_EQ(row["theta_deg"], 80);
  EXPECT_DOUBLE_EQ(row["albedo"][0], 0.1 * basis.values[0] + 0.3 * basis.values[1]);
  EXPECT_LE(row["error"][0].get<double>(), 1e-8 * row["albedo"][0].get<double>());
  EXPECT_EQ(row["over_one"], (nlohmann::json{false}));
}

TEST(AlbedoCommand, DependsOnTheAzimuthOfABrushedMaterialOnly) {
  const TemporaryFolder folder;
  const auto at = [&](std::string_view material, const char* phi) {
    return nlohmann::json::parse(run_gonio({"albedo", folder.write("material.json", material),
                                            "--theta", "85", "--phi", phi, "--json"})
                                     .out)["angles"][0]["albedo"][0]
        .get<double>();
  };
  EXPECT_GT(std::abs(at(brushed, "0") / at(brushed, "90") - 1), 0.01);
  EXPECT_NEAR(at(duer, "0") / at(duer, "77"), 1, 1e-6);
}

TEST(AlbedoCommand, SaysWhereItCannotReachTheTolerance) {
  // The rounding of the directions moves a slope by 1e-16 / cos_i, here by a third of alpha.
  constexpr std::string_view sharp = R"({
    "format": "gonio-material", "version": 1, "model": "ward", "channels": ["Y"],
    "parameters": {"rho_d": {"value": [0]}, "rho_s": {"value": [1]}, "alpha": {"value": 1e-4}}})";
  const TemporaryFolder folder;
  const auto result = run_gonio({"albedo", folder.write("sharp.json", sharp), "--theta",
                                 "89.9999999999", "--tolerance", "1e-10"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_THAT(result.err, HasSubstr("theta 89.9999999999 deg: the relative error may be"));
}

TEST(AlbedoCommand, RefusesWhatIsNoAngleInOneClearLine) {
  const TemporaryFolder folder;
  const std::string material = folder.write("duer.json", duer);
  const auto expect_refused = [&](const char* option, const char* value, const char* expected) {
    const auto result = run_gonio({"albedo", material, option, value});
    EXPECT_EQ(result.exit_status, 2) << option << " " << value;
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, AllOf(HasSubstr(option), HasSubstr(expected)));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  expect_refused("--theta", "90", "90 degrees, expected 0 to less than 90");
  expect_refused("--theta", "10,-1", "-1 degrees, expected 0 to less than 90");
  expect_refused("--theta", "nan", "expected 0 to less than 90");
  expect_refused("--theta", "10,,20", "expected polar angles in degrees, such as 0,45,80");
  expect_refused("--theta", "ten", "expected polar angles in degrees, such as 0,45,80");
  expect_refused("--phi", "inf", "expected an azimuth in degrees");
  expect_refused("--tolerance", "0", "expected a relative error from 1e-10 to 0.1");
  EXPECT_EQ(run_gonio({"albedo", folder / "absent.json"}).exit_status, 3);
}

// The warning of a fit --------------------------------------------------------------------------

/// A noise-free table of the model with alpha 0.3, rho_d 0.2 and 0.1, rho_s 0.4 and 0.7, and the
/// fit of the model to it.
fit::FitResult fitted(std::string_view model, std::vector<double> incidence_angles_deg) {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], model);
  recipe.channels = {"R", "G"};
  recipe.parameters = {{"rho_d", {0.2, 0.1}}, {"rho_s", {0.4, 0.7}}, {"alpha", {0.3}}};
  recipe.incidence_angles_deg = std::move(incidence_angles_deg);
  return fit::fit(brdf::Model(model), instrument::synthesize(recipe), {.max_theta_deg = 89});
}

TEST(AlbedoWarning, NamesTheAngleAmongTheSamplesAndTheWorstChannel) {
  const fit::FitResult result = fitted("ward-duer", {20, 50, 86});
  const double lobe =
      brdf::basis_albedo(brdf::Model("ward-duer"), std::array{0.3}, 86 * radians_per_degree, 0)
          .values[1];
  EXPECT_THAT(result.warnings,
              Contains(HasSubstr(fmt::format("albedo of channel G is {:.3g} for light from 86 deg",
                                             0.1 + 0.7 * lobe))));
}

TEST(AlbedoWarning, IsNotGivenForAnglesThatTheSamplesDoNotReach) {
  // At 75 deg the albedo of G is 0.1 + 0.7 * 0.838.
  EXPECT_THAT(fitted("ward-duer", {20, 50, 75}).warnings, Not(Contains(HasSubstr("albedo of"))));
}

TEST(AlbedoWarning, IsNotGivenForABoundedLobe) {
  EXPECT_THAT(fitted("ward-gmd", {20, 50, 86}).warnings, Not(Contains(HasSubstr("albedo of"))));
}

}  // namespace
}  // namespace gonio::tests
