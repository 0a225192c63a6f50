// What `gonio eval` and `gonio models` print, for people and for programs.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "brdf/bound_model.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::string_view brass = R"({
  "format": "gonio-material", "version": 1, "model": "ward-aniso", "channels": ["R", "G"],
  "parameters": {"rho_d": {"value": [0.1, 0.2]}, "rho_s": {"value": [0.3, 0.4]},
                 "alpha_x": {"value": 0.05}, "alpha_y": {"value": 0.16}}})";

constexpr std::string_view table =
    "# gonio-table 1\n# quantity: brdf\n# angles: deg\n# name: brass\n"
    "theta_i,phi_i,theta_o,phi_o,Y\n"
    "30,0,3.20e1,180,0.5\n"
    "30,+0,10,90,\n"
    "90,0,10,90,0.1\n";

std::array<double, 2> expected(double theta_i, double phi_i, double theta_o, double phi_o) {
  const brdf::Model model("ward-aniso");
  const auto wi = brdf::direction_from_degrees(theta_i, phi_i);
  const auto wo = brdf::direction_from_degrees(theta_o, phi_o);
  const std::array shape{0.05, 0.16};
  return {model.evaluate(std::array{0.1, 0.3}, shape, wi, wo),
          model.evaluate(std::array{0.2, 0.4}, shape, wi, wo)};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(EvalCommand, PrintsEveryChannelWithAllItsDigits) {
  const TemporaryFolder folder;
  const std::string material = folder.write("brass.json", brass);
  const auto result = run_gonio({"eval", material, "--wi", "30,0", "--wo", "32,180"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  const auto f_r = expected(30, 0, 32, 180);
  EXPECT_EQ(result.out, fmt::format("R {}\nG {}\n", f_r[0], f_r[1]));
}

TEST(EvalCommand, TellsProgramsTheSame) {
  const TemporaryFolder folder;
  const std::string material = folder.write("brass.json", brass);
  const auto result = run_gonio({"eval", material, "--wi", "30,-20.5", "--wo", "32,180", "--json"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["model"], "lambert+ward-aniso");
  EXPECT_EQ(json["wi"]["phi_deg"], -20.5);
  EXPECT_EQ(json["channels"], (nlohmann::json{"R", "G"}));
  const auto f_r = expected(30, -20.5, 32, 180);
  EXPECT_EQ(json["f_r"], (nlohmann::json{f_r[0], f_r[1]}));
}

TEST(EvalCommand, TurnsTheTangentByPsi) {
  const TemporaryFolder folder;
  std::string turned(brass);
  turned.replace(turned.find("\"alpha_x\""), 9, R"("psi": {"value": 0.5}, "alpha_x")");
  const auto result = run_gonio(
      {"eval", folder.write("turned.json", turned), "--wi", "30,0", "--wo", "32,150", "--json"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const double psi_deg = 0.5 * 180 / std::numbers::pi;
  const auto f_r = expected(30, -psi_deg, 32, 150 - psi_deg);
  const auto printed = nlohmann::json::parse(result.out)["f_r"];
  // Slopes wrong by 1e-15 move an exponent of 30 by 2 * 5.5 * 1e-15 / 0.05 = 2e-13.
  for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(printed[c].get<double>() / f_r[c], 1, 1e-12);
}

TEST(EvalCommand, EchoesATableWithAColumnPerChannelOfTheMaterial) {
  const TemporaryFolder folder;
  const auto result = run_gonio(
      {"eval", folder.write("brass.json", brass), "--table", folder.write("table.csv", table)});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const auto first = expected(30, 0, 32, 180);
  const auto second = expected(30, 0, 10, 90);
  EXPECT_THAT(
      lines_of(result.out),
      ElementsAre("# gonio-table 1", "# quantity: brdf", "# angles: deg", "# name: brass",
                  "theta_i,phi_i,theta_o,phi_o,Y,R_model,G_model",
                  fmt::format("30,0,3.20e1,180,0.5,{},{}", first[0], first[1]),
                  fmt::format("30,+0,10,90,,{},{}", second[0], second[1]), "90,0,10,90,0.1,0,0"));
}

TEST(EvalCommand, RefusesColumnsThatCouldNotBeToldApart) {
  const TemporaryFolder folder;
  const std::string material = folder.write("brass.json", brass);
  std::string clash(table);
  clash.replace(clash.find(",Y\n"), 3, ",G_model\n");
  const auto result = run_gonio({"eval", material, "--table", folder.write("table.csv", clash)});
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, AllOf(HasSubstr("table.csv"), HasSubstr("'G_model'")));
}

TEST(EvalCommand, RefusesDirectionsThatAreNone) {
  const TemporaryFolder folder;
  const std::string material = folder.write("brass.json", brass);
  for (const std::string wi : {"90.001,0", "-1,0", "30", "30,0,0", "30;0", "a,b", "nan,0", "30,inf",
                               ",", "30, 0", "0x10,0"}) {
    const auto result = run_gonio({"eval", material, "--wi=" + wi, "--wo", "30,0"});
    EXPECT_EQ(result.exit_status, 2) << wi;
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, HasSubstr("--wi " + wi));
  }
}

TEST(EvalCommand, WantsEitherDirectionsOrATable) {
  const TemporaryFolder folder;
  const std::string material = folder.write("brass.json", brass);
  const std::string samples = folder.write("table.csv", table);
  for (const auto& options : std::vector<std::vector<std::string>>{
           {},
           {"--wi", "30,0"},
           {"--wo", "30,0"},
           {"--wi", "30,0", "--wo", "30,0", "--table", samples}}) {
    std::vector<std::string> arguments{"eval", material};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = run_gonio(arguments);
    EXPECT_EQ(result.exit_status, 2);
    EXPECT_THAT(result.err, AllOf(HasSubstr("eval: "), HasSubstr("THETA,PHI")));
  }
}

TEST(EvalCommand, IsZeroAtTheHorizon) {
  const TemporaryFolder folder;
  const auto result =
      run_gonio({"eval", folder.write("brass.json", brass), "--wi", "90,0", "--wo", "30,180"});
  EXPECT_EQ(result.out, "R 0\nG 0\n");
}

TEST(ModelsCommand, ListsEveryTermAndModelInAHundredColumns) {
  const auto result = run_gonio({"models"});
  EXPECT_EQ(result.exit_status, 0);
  for (const brdf::TermEntry& term : brdf::all_terms()) {
    EXPECT_THAT(result.out, HasSubstr(fmt::format("\n  {} ", term.description.name)));
  }
  for (const std::string& name : brdf::model_names()) {
    EXPECT_THAT(result.out, HasSubstr("\n  " + name + " "));
    for (const std::string& line : lines_of(run_gonio({"models", name}).out)) {
      EXPECT_LE(line.size(), 100U) << line;
    }
  }
  for (const std::string& line : lines_of(result.out)) EXPECT_LE(line.size(), 100U) << line;
}

TEST(ModelsCommand, ExplainsEveryParameterOfAModel) {
  const auto result = run_gonio({"models", "ward-aniso", "--json"});
  ASSERT_EQ(result.exit_status, 0);
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["model"], "lambert+ward-aniso");
  const auto& parameters = json["parameters"];
  ASSERT_EQ(parameters.size(), 4U);
  EXPECT_EQ(parameters[1]["name"], "rho_s");
  EXPECT_EQ(parameters[1]["per_channel"], true);
  EXPECT_EQ(parameters[1]["upper"], nullptr) << "no upper bound";
  EXPECT_EQ(parameters[2]["name"], "alpha_x");
  EXPECT_EQ(parameters[2]["lower"], 1e-4);
  EXPECT_EQ(parameters[2]["upper"], 10);
  EXPECT_FALSE(parameters[2]["meaning"].get<std::string>().empty());
}

TEST(ModelsCommand, SaysWhatAFreeFrameAdds) {
  const auto result = run_gonio({"models", "ward-aniso"});
  EXPECT_THAT(result.out, AllOf(HasSubstr("with --free-frame\n"),
                                HasSubstr("\n  psi       rad   -pi/2..pi/2 shared ")));
  EXPECT_THAT(run_gonio({"models", "ward"}).out, Not(HasSubstr("psi")));
  const auto json =
      nlohmann::json::parse(run_gonio({"models", "lambert+ward+ward-aniso", "--json"}).out);
  ASSERT_EQ(json["free_frame_parameters"].size(), 1U);
  const auto& psi = json["free_frame_parameters"][0];
  EXPECT_EQ(psi["name"], "psi_2");
  EXPECT_EQ(psi["upper"], std::numbers::pi / 2);
  EXPECT_EQ(psi["per_channel"], false);
}

TEST(ModelsCommand, ShowsASecondLobeWithItsOwnParameters) {
  const auto result = run_gonio({"models", "lambert+ward+ward"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("rho_s ward(wi, wo; alpha) + rho_s_2 ward(wi, wo; alpha_2)"),
                    HasSubstr("\n  rho_s_2 "), HasSubstr("\n  alpha_2 ")));
  const std::string heading = "\nward (specular)\n";
  const std::size_t first = result.out.find(heading);
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(result.out.find(heading, first + 1), std::string::npos) << "one formula for both";
  for (const std::string& line :
       lines_of(run_gonio({"models", "lambert+ward-approx-aniso+ward-gmd-aniso"}).out)) {
    EXPECT_LE(line.size(), 100U) << line;
  }
}

TEST(ModelsCommand, ListsWhatThereIsForAnUnknownModel) {
  const auto result = run_gonio({"models", "torrance"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("torrance"), HasSubstr("ward-gmd-aniso")));
}

}  // namespace
}  // namespace gonio::tests
