// Materials with a turned tangent or with two lobes: through their file and through the virtual
// gonioreflectometer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <numbers>
#include <random>

#include "instrument/synthesize.h"
#include "material/evaluate.h"
#include "material/material_json.h"
#include "table/file_error.h"
#include "table/json_file.h"

namespace gonio::tests {
namespace {

using material::Material;
using material::model_of;
using material::parse_material;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* turned_brass = R"({
  "format": "gonio-material", "version": 1, "model": "ward-aniso", "channels": ["R", "G"],
  "parameters": {"rho_d": {"value": [0.1, 0.2]}, "rho_s": {"value": [0.3, 0]},
                 "psi": {"value": 0.5}, "alpha_x": {"value": 0.05}, "alpha_y": {"value": 0.16}}})";

constexpr const char* two_lobes = R"({
  "format": "gonio-material", "version": 1, "model": "lambert+ward-aniso+ward-aniso",
  "channels": ["R", "G"],
  "parameters": {"psi_2": {"value": 0.25}, "alpha_y_2": {"value": 0.4}, "alpha_x_2": {"value": 0.3},
                 "rho_s_2": {"value": [0.05, 0.06]},
                 "rho_d": {"value": [0.1, 0.2]}, "rho_s": {"value": [0.3, 0]},
                 "alpha_x": {"value": 0.05}, "alpha_y": {"value": 0.16}, "psi": {"value": -1}}})";

std::string without(std::string text, std::string_view part) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.erase(at, part.size());
}

std::string text_of(const Material& m) { return table::json_text(material::to_json(m)); }

std::vector<std::string> parameter_names(const Material& m) {
  std::vector<std::string> names;
  for (const auto& p : m.parameters) names.push_back(p.name);
  return names;
}

TEST(TurnedMaterial, IsToldByItsTangentAngle) {
  const Material m = parse_material(turned_brass, "brass.json");
  EXPECT_TRUE(model_of(m).has_free_frame());
  EXPECT_EQ(m.model, "lambert+ward-aniso") << "the frame is no part of the name";
  EXPECT_THAT(parameter_names(m), ElementsAre("rho_d", "rho_s", "alpha_x", "alpha_y", "psi"));
  const std::string fixed = without(turned_brass, R"("psi": {"value": 0.5}, )");
  EXPECT_FALSE(model_of(parse_material(fixed, "brass.json")).has_free_frame());
}

TEST(TurnedMaterial, KeepsItsTangentAngleToTheLastBit) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> angles(-1.5707, 1.5707);
  Material m = parse_material(turned_brass, "brass.json");
  for (int i = 0; i < 200; ++i) {
    const double psi = i < 2 ? (i - 0.5) * std::numbers::pi : angles(generator);  // the bounds too
    m.parameters[4].value = {psi};
    const Material read = parse_material(text_of(m), "brass.json");
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read.parameters[4].value[0]),
              std::bit_cast<std::uint64_t>(psi));
  }
  EXPECT_TRUE(material::to_json(m)["parameters"]["psi"]["value"].is_number()) << "no array";
}

TEST(MaterialOfTwoLobes, HasItsParametersInTheModelsOrder) {
  const Material m = parse_material(two_lobes, "car.json");
  EXPECT_THAT(parameter_names(m), ElementsAre("rho_d", "rho_s", "alpha_x", "alpha_y", "psi",
                                              "rho_s_2", "alpha_x_2", "alpha_y_2", "psi_2"));
  const std::string once = text_of(m);
  EXPECT_EQ(text_of(parse_material(once, "car.json")), once) << "written again, the same text";
}

TEST(MaterialOfTwoLobes, HasBothTangentAnglesOrNone) {
  const std::string one = without(two_lobes, R"(, "psi": {"value": -1})");
  try {
    parse_material(one, "car.json");
    ADD_FAILURE() << "one angle for two tangents was accepted";
  } catch (const table::FileError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("car.json: /parameters: \"psi\": missing, expected all parameters"));
  }
  const std::string none = without(one, R"("psi_2": {"value": 0.25}, )");
  EXPECT_FALSE(model_of(parse_material(none, "car.json")).has_free_frame());
}

instrument::Recipe noise_free_brass() {
  instrument::Recipe r;
  r.name = "brass";
  r.model = "ward-aniso";
  r.channels = {"Y"};
  r.parameters = {{"rho_d", {0.1}}, {"rho_s", {0.33}}, {"alpha_x", {0.05}}, {"alpha_y", {0.16}}};
  r.incidence_angles_deg = {0, 40};
  r.sample_rotations_deg = {0};
  r.hemisphere = {.theta_step_deg = 20, .phi_step_deg = 90};
  r.mirror_patch =
      instrument::MirrorPatch{.radius_step_deg = 2, .radius_max_deg = 4, .directions_per_ring = 6};
  return r;
}

TEST(TurnedMaterial, IsMeasuredAsIfTheSampleWereTurned) {
  instrument::Recipe turned_sample = noise_free_brass();
  turned_sample.sample_rotations_deg = {30};
  instrument::Recipe turned_tangent = noise_free_brass();
  turned_tangent.parameters["psi"] = {std::numbers::pi / 6};
  const auto expected = synthesize(turned_sample);
  const auto t = synthesize(turned_tangent);
  ASSERT_EQ(t.size(), expected.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    // Azimuths are rounded to 1e-6 deg = 1.7e-8 and slopes are below 1, so that an exponent below
    // 30 at alpha 0.05 moves by 2 * 5.5 * 1.7e-8 / 0.05 = 4e-6; darker, the diffuse part rules.
    EXPECT_NEAR(t.values[0][i] / expected.values[0][i], 1, 1e-5);
  }
}

TEST(MaterialOfTwoLobes, IsMeasuredAsTheSumOfBoth) {
  instrument::Recipe recipe = noise_free_brass();
  recipe.model = "lambert+ward-aniso+ward";
  recipe.parameters["rho_s_2"] = {0.2};
  recipe.parameters["alpha_2"] = {0.4};
  const auto both = synthesize(recipe);
  const auto first = synthesize(noise_free_brass());
  recipe.model = "lambert+ward";
  recipe.parameters = {{"rho_d", {0}}, {"rho_s", {0.2}}, {"alpha", {0.4}}};
  const auto second = synthesize(recipe);
  for (std::size_t i = 0; i < both.size(); ++i) {
    EXPECT_DOUBLE_EQ(both.values[0][i], first.values[0][i] + second.values[0][i]);
  }
}

}  // namespace
}  // namespace gonio::tests
