// Recipes: what they say, and what is refused with which words.
#include "instrument/recipe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "instrument/synthesize.h"
#include "table/file_error.h"

namespace gonio::instrument {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* complete = R"({
  "$schema": "x", "format": "gonio-recipe", "version": 1, "name": "brass", "comment": "why",
  "model": "ward-aniso", "channels": ["R", "G"],
  "parameters": {"rho_d": [0.1, 0.2], "rho_s": [0.3, 0.4], "alpha_x": 0.05, "alpha_y": 0.16},
  "incidence_angles_deg": [0, 45.5], "sample_rotations_deg": [0, 90, -30],
  "exitant_directions": {"theta_max_deg": 75,
    "hemisphere": {"theta_step_deg": 15, "phi_step_deg": 40},
    "mirror_patch": {"radius_step_deg": 1.5, "radius_max_deg": 6, "directions_per_ring": 8}},
  "noise": {"relative": 0.02, "floor": 0.001, "seed": 18446744073709551615},
  "sigma_columns": true, "quantity": "reflectance_factor"})";

std::string changed(std::string_view from, std::string_view to) {
  std::string text = complete;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string refusal(const std::string& text) {
  try {
    parse_recipe(text, "brass.json");
  } catch (const table::FileError& error) {
    return error.what();
  }
  return "";
}

TEST(RecipeTest, SaysAllThatItHolds) {
  const Recipe r = parse_recipe(complete, "brass.json");
  EXPECT_EQ(r.name, "brass");
  EXPECT_EQ(r.comment, "why");
  EXPECT_EQ(r.model, "ward-aniso");
  EXPECT_THAT(r.channels, ElementsAre("R", "G"));
  EXPECT_THAT(r.parameters.at("rho_s"), ElementsAre(0.3, 0.4));
  EXPECT_THAT(r.parameters.at("alpha_y"), ElementsAre(0.16));
  EXPECT_THAT(r.incidence_angles_deg, ElementsAre(0, 45.5));
  EXPECT_THAT(r.sample_rotations_deg, ElementsAre(0, 90, -30));
  EXPECT_EQ(r.theta_max_deg, 75);
  EXPECT_EQ(r.hemisphere.theta_step_deg, 15);
  EXPECT_EQ(r.hemisphere.phi_step_deg, 40);
  ASSERT_TRUE(r.mirror_patch);
  EXPECT_EQ(r.mirror_patch->radius_step_deg, 1.5);
  EXPECT_EQ(r.mirror_patch->radius_max_deg, 6);
  EXPECT_EQ(r.mirror_patch->directions_per_ring, 8U);
  EXPECT_EQ(r.noise.relative, 0.02);
  EXPECT_EQ(r.noise.floor, 0.001);
  EXPECT_EQ(r.noise.seed, 18446744073709551615U);
  EXPECT_TRUE(r.sigma_columns);
  EXPECT_EQ(r.quantity, table::Quantity::reflectance_factor);
}

TEST(RecipeTest, NoiseSigmaPatchAndQuantityMayBeLeftOut) {
  const Recipe r = parse_recipe(R"({"format": "gonio-recipe", "version": 1, "name": "grey",
      "model": "lambert", "channels": ["Y"], "parameters": {"rho_d": 0.5},
      "incidence_angles_deg": [30], "sample_rotations_deg": [0], "exitant_directions":
      {"theta_max_deg": 80, "hemisphere": {"theta_step_deg": 10, "phi_step_deg": 30}}})",
                                "grey.json");
  EXPECT_EQ(r.noise.relative, 0);
  EXPECT_EQ(r.noise.floor, 0);
  EXPECT_FALSE(r.sigma_columns);
  EXPECT_FALSE(r.mirror_patch);
  EXPECT_EQ(r.quantity, table::Quantity::brdf);
}

TEST(RecipeTest, MayTurnTheTangent) {
  const Recipe r = parse_recipe(changed("\"alpha_x\"", "\"psi\": -0.5, \"alpha_x\""), "brass.json");
  EXPECT_THAT(r.parameters.at("psi"), ElementsAre(-0.5));
  EXPECT_TRUE(bind(r).model().has_free_frame());
  EXPECT_FALSE(bind(parse_recipe(complete, "brass.json")).model().has_free_frame());
}

TEST(RecipeTest, SaysWhichFieldIsWrongAndWhatWasExpected) {
  struct Case {
    std::string text, part;
  };
  const Case cases[] = {
      {changed("gonio-recipe", "gonio-material"), "/format: found \"gonio-material\", expected"},
      {changed("\"version\": 1", "\"version\": 2"), "/version: found version 2"},
      {changed("\"seed\"", "\"sead\""), "/noise/sead: unknown member, expected one of relative"},
      {changed("\"comment\"", "\"remark\""), "/remark: unknown member"},
      {changed("\"hemisphere\"", "\"sphere\""), "/exitant_directions/sphere: unknown member"},
      {changed("\"name\": \"brass\", ", ""), "the document: the member \"name\" is missing"},
      {changed("ward-aniso", "phlogiston"), "/model: model 'phlogiston'"},
      {changed("[0.1, 0.2]", "0.1"), "/parameters/rho_d: found 1 value, expected 2"},
      {changed("[0.1, 0.2]", "{\"value\": 1}"), "/parameters/rho_d: found an object, expected"},
      {changed("0.05", "20"), "/parameters/alpha_x: found 20, outside the bounds"},
      {changed(", \"alpha_y\": 0.16", ""), "/parameters/alpha_y: missing"},
      {changed("alpha_y", "alpha_z"), "/parameters/alpha_z: not a parameter"},
      {changed("\"alpha_x\"", "\"psi\": 30, \"alpha_x\""),
       "/parameters/psi: found 30, outside the bounds of psi, expected -1.5707963267948966 to "
       "1.5707963267948966, in rad"},
      {changed("\"alpha_x\"", "\"psi_2\": 0.3, \"alpha_x\""),
       "/parameters/psi_2: not a parameter of lambert+ward-aniso"},
      {changed("ward-aniso", "lambert+ward-aniso+ward"), "/parameters/rho_s_2: missing"},
      {changed("[\"R\", \"G\"]", "[\"R\", \"R\"]"), "/channels: the channel 'R' stands twice"},
      {changed("[0, 45.5]", "[]"), "/incidence_angles_deg: found no angle"},
      {changed("[0, 45.5]", "[0, 90]"), "/incidence_angles_deg/1: found 90 degrees, expected 0 to"},
      {changed("[0, 45.5]", "[-1, 9]"), "/incidence_angles_deg/0: found -1 degrees"},
      {changed("[0, 90, -30]", "[0, 361]"), "/sample_rotations_deg/1: found 361 degrees"},
      {changed("\"theta_max_deg\": 75", "\"theta_max_deg\": 91"),
       "/exitant_directions/theta_max_deg: found 91, expected 0 to 90"},
      {changed("\"theta_step_deg\": 15", "\"theta_step_deg\": 0"),
       "/exitant_directions/hemisphere/theta_step_deg: found 0, expected 0.001 to 90"},
      {changed("\"phi_step_deg\": 40", "\"phi_step_deg\": -40"),
       "/exitant_directions/hemisphere/phi_step_deg: found -40"},
      {changed("1.5", "0"), "/exitant_directions/mirror_patch/radius_step_deg: found 0"},
      {changed("\"directions_per_ring\": 8", "\"directions_per_ring\": 0"),
       "/exitant_directions/mirror_patch/directions_per_ring: found 0"},
      {changed("\"directions_per_ring\": 8", "\"directions_per_ring\": 8.5"),
       "/exitant_directions/mirror_patch/directions_per_ring: found 8.5, expected a whole"},
      {changed("0.02", "-0.02"), "/noise/relative: found -0.02"},
      {changed("0.001", "-1"), "/noise/floor: found -1"},
      {changed("18446744073709551615", "-1"), "/noise/seed: found -1, expected a whole number"},
      {changed("0.001", "0"), "/sigma_columns: found true with a noise floor of 0"},
      {changed("true", "\"yes\""), "/sigma_columns: found \"yes\", expected true or false"},
      {changed("reflectance_factor", "radiance"), "/quantity: found \"radiance\", expected brdf"},
      {changed("\"theta_step_deg\": 15, \"phi_step_deg\": 40",
               "\"theta_step_deg\": 0.001, \"phi_step_deg\": 0.001"),
       "/exitant_directions: found 162000000"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    const std::string message = refusal(c.text);
    EXPECT_THAT(message, StartsWith("brass.json: "));
    EXPECT_THAT(message, HasSubstr(c.part));
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one line";
  }
}

TEST(RecipeTest, ARecipeMadeInCodeIsCheckedAlike) {
  Recipe recipe = parse_recipe(complete, "brass.json");
  recipe.incidence_angles_deg.push_back(95);
  try {
    synthesize(recipe);
    ADD_FAILURE() << "a lamp below the horizon was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("/incidence_angles_deg/2: found 95"));
  }
}

}  // namespace
}  // namespace gonio::instrument
