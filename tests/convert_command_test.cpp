// `gonio convert` as users meet it: single lobes, lists, material libraries and materials, and what
// it says of bad ones.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "material/material_json.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

double value_of(const material::Material& material, std::string_view name, std::size_t channel) {
  for (const material::ParameterValue& p : material.parameters) {
    if (p.name == name) return p.value.at(channel);
  }
  ADD_FAILURE() << "no " << name;
  return 0;
}

TEST(ConvertCommand, ShowsBothMethodsWithTheErrorThatRemains) {
  const auto result = run_gonio({"convert", "phong", "--exponent", "50"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, AllOf(HasSubstr("phong, exponent 50, ks 1, as ward"),
                                HasSubstr("closed-form    0.0995037"),  // sqrt(2 / 202)
                                HasSubstr("best-fit"), HasSubstr("peak"), HasSubstr("rms"),
                                HasSubstr("albedo"), HasSubstr("0, 15, 30, 45, 60, 75 deg")));
}

TEST(ConvertCommand, GivesProgramsEveryDigit) {
  const auto result = run_gonio({"convert", "blinn-phong", "--exponent", "50", "--ks", "2",
                                 "--amplitude", "normalised", "--to", "ward-gmd", "--json"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  const auto& closed = json["conversions"][0];
  EXPECT_EQ(closed["conversion"]["method"], "closed-form");
  EXPECT_EQ(closed["parameters"]["alpha"]["value"], std::sqrt(2 / 52.0));
  // ks = 2 * 52 / (2 pi); rho_s = 4 pi alpha^2 ks.
  EXPECT_NEAR(closed["parameters"]["rho_s"]["value"][0], 8, 1e-13);
  const auto& best = json["conversions"][1];
  EXPECT_EQ(best["model"], "lambert+ward-gmd");
  EXPECT_LE(best["conversion"]["error"]["metric"], closed["conversion"]["error"]["metric"]);
  EXPECT_EQ(best["conversion"]["theta_i_deg"].size(), 6U);
  EXPECT_GT(best["conversion"]["error"]["rms"], 0);
  EXPECT_EQ(best["provenance"]["command"],
            "gonio convert blinn-phong --exponent 50 --ks 2 --amplitude normalised --to ward-gmd "
            "--json");
}

TEST(ConvertCommand, WritesAMaterialThatIsReadBack) {
  const TemporaryFolder folder;
  const std::string path = folder / "ward.json";
  const auto result =
      run_gonio({"convert", "phong", "--exponent", "50", "--method", "closed-form", "-o", path});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, Not(HasSubstr("best-fit")));
  const auto material = material::read_material(path);
  EXPECT_EQ(value_of(material, "alpha", 0), std::sqrt(2 / 202.0));
  EXPECT_EQ(material.conversion->from, "phong, exponent 50");
  EXPECT_EQ(material.conversion->method, "closed-form");
}

TEST(ConvertCommand, TellsWhereThereIsNoClosedForm) {
  const auto both = run_gonio({"convert", "ward", "--alpha", "2"});
  EXPECT_EQ(both.exit_status, 0);
  EXPECT_THAT(both.out, AllOf(HasSubstr("none: "), HasSubstr("roughness above 1")));
  const auto alone = run_gonio({"convert", "ward", "--alpha", "2", "--method", "closed-form"});
  EXPECT_EQ(alone.exit_status, 2);
}

struct Refusal {
  std::vector<std::string> arguments;
  const char* message;
};

TEST(ConvertCommand, RefusesWrongUsageInOneLine) {
  const std::vector<Refusal> refusals{
      {{"phong"}, "its width is given by --exponent"},
      {{"phong", "--exponent", "0"}, "more than 0"},
      {{"phong", "--exponent", "-3"}, "more than 0"},
      {{"phong", "--exponent", "many"}, "expected a number"},
      {{"phong", "--exponent", "2e6"}, "up to 1e+06"},
      {{"phong", "--alpha", "0.1"}, "its width is given by --exponent"},
      {{"ward", "--alpha", "20"}, "expected 0.0001 to 10"},
      {{"ward", "--alpha", "0.1", "--ks", "1"}, "--ks is no amplitude"},
      {{"ward", "--alpha", "0.1", "--amplitude", "normalised"}, "says how a given ks is meant"},
      {{"ward", "--alpha", "0.1", "--amplitude", "classic", "-o", "x.json"},
       "no material of gonio"},
      {{"ward", "--alpha", "0.1", "--amplitude", "classic", "--to", "ward"}, "classic highlight"},
      {{"phong", "--exponent", "5", "--ks", "-1"}, "expected 0 to"},
      {{"phong", "--exponent", "5", "--amplitude", "rough"}, "raw, normalised and classic"},
      {{"phong", "--exponent", "5", "--to", "wart"}, "did you mean 'ward'?"},
      {{"phong", "--exponent", "5", "--to", "ward-aniso"}, "no such isotropic lobe"},
      {{"phong", "--exponent", "5", "--method", "guess"}, "closed-form and best-fit"},
      {{"phong", "--exponent", "5", "--metric", "chi2"}, "noise of a measurement"},
      {{"phong", "--exponent", "5", "--theta", "90"}, "less than 90"},
      {{"phong", "--exponent", "5", "--theta", "0,85"}, "compared up to 80"},
      {{"phong", "--exponent", "5", "--default-exponent", "3"}, "says nothing here"},
      {{"phongg", "--exponent", "5"}, "did you mean 'phong'?"}};
  for (const Refusal& refusal : refusals) {
    std::vector<std::string> arguments{"convert"};
    arguments.insert(arguments.end(), refusal.arguments.begin(), refusal.arguments.end());
    const auto result = run_gonio(arguments);
    EXPECT_EQ(result.exit_status, 2) << refusal.message;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, AllOf(StartsWith("gonio: "), HasSubstr(refusal.message)));
    EXPECT_EQ(lines_of(result.err).size(), 1U) << result.err;
  }
}

TEST(ConvertCommand, ConvertsACsvRowByRowPastBadOnes) {
  const TemporaryFolder folder;
  const auto result =
      run_gonio({"convert",
                 folder.write("lobes.csv",
                              "# a comment\r\nname,exponent,ks\r\nmatt,5,0.1\r\nbad,-1,0.1\r\n"
                              "odd,abc,1\r\nshort,3\r\nsharp,1000,0.2\r\n"),
                 "--method", "closed-form"});
  EXPECT_EQ(result.exit_status, 1);
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 6U) << result.out;
  EXPECT_EQ(lines[0],
            "name,exponent,ks,to,to_alpha,to_rho_s,method,metric_error,peak,rms,albedo,problem");
  EXPECT_THAT(lines[1], StartsWith(fmt::format("matt,5,0.1,ward,{},", std::sqrt(2 / 7.0))));
  EXPECT_EQ(
      lines[2],
      "bad,-1,0.1,,,,,,,,,the exponent is -1; expected more than 0 and up to 1e+06; at 0 there is "
      "no highlight");
  EXPECT_THAT(lines[3], HasSubstr("expected a number"));
  EXPECT_THAT(lines[4], HasSubstr("2 fields; expected 3"));
  EXPECT_THAT(lines[5], StartsWith(fmt::format("sharp,1000,0.2,ward,{},", std::sqrt(2 / 1002.0))));
  EXPECT_THAT(lines_of(result.err),
              ElementsAre(HasSubstr("lobes.csv:4: the exponent is -1"), HasSubstr("lobes.csv:5:"),
                          HasSubstr("lobes.csv:6:")));
}

TEST(ConvertCommand, TakesACsvOfRoughnessBack) {
  const TemporaryFolder folder;
  const std::string path = folder.write("ward.csv", "\"alpha\"\n0.5\n");
  const auto result = run_gonio({"convert", path, "--method", "closed-form"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("blinn-phong,6,"));  // 2 / 0.5^2 - 2
  EXPECT_EQ(run_gonio({"convert", path, "--amplitude", "classic"}).exit_status, 2);
  const std::string exponents = folder.write("phong.csv", "exponent\n5\n");
  EXPECT_EQ(run_gonio({"convert", exponents, "--amplitude", "foo"}).exit_status, 2);
  const auto overwriting = run_gonio({"convert", exponents, "-o", exponents});
  EXPECT_EQ(overwriting.exit_status, 2);
  EXPECT_EQ(content_of(exponents), "exponent\n5\n");
}

TEST(ConvertCommand, DoesTheOthersWhereNothingCanBeFitted) {
  const TemporaryFolder folder;
  // Of 1e-200 there is no square.
  const auto result =
      run_gonio({"convert", folder.write("lobes.csv", "exponent,ks\n50,1\n60,1e-200\n70,1\n")});
  EXPECT_EQ(result.exit_status, 1);
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 4U) << result.out;
  EXPECT_THAT(lines[2], HasSubstr("nothing can be fitted"));
  EXPECT_THAT(lines[3], HasSubstr("best-fit"));
}

TEST(ConvertCommand, RefusesACsvThatDoesNotSayWhatItHolds) {
  const TemporaryFolder folder;
  for (const char* text : {"5\n10\n", "name,ks\na,1\n", "exponent,alpha\n1,1\n",
                           "exponent,exponent\n1,1\n", "exponent\n"}) {
    const auto result = run_gonio({"convert", folder.write("lobes.csv", text)});
    EXPECT_EQ(result.exit_status, 3) << text;
    EXPECT_EQ(lines_of(result.err).size(), 1U) << result.err;
  }
}

constexpr std::string_view library = R"(# ten of a kind
newmtl red plastic
Kd 0.6 0.1 0.1
Ks 0.2 0.2 0.2
Ns 96.078431
illum 2

newmtl wall
Kd 0.8 0.8 0.75
Ns 0
illum 1

newmtl no exponent
Kd 0.5 0.5 0.5
Ks 0.3 0.3 0.3

newmtl negative
Kd 0.5 0.5 0.5
Ks 0.3 0.3 0.3
Ns -5

newmtl Red_Plastic
Kd 0.1 0.1 0.6
Ks 0.1 0.2 0.3
Ns 1000
)";

TEST(ConvertCommand, ConvertsALibraryPastBadMaterials) {
  const TemporaryFolder folder;
  const TemporaryFolder out;
  const auto result = run_gonio({"convert", folder.write("old.mtl", library), "-o", out / "ward"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("no exponent"), HasSubstr("--default-exponent"),
                                HasSubstr("negative"), HasSubstr("3 of 5 materials converted")));
  EXPECT_THAT(result.out, AllOf(HasSubstr("red plastic"), HasSubstr("wall"), HasSubstr("exact")));
  const auto red = material::read_material(out / "ward/red_plastic.json");
  EXPECT_EQ(red.name, "red plastic");
  EXPECT_EQ(red.model, "lambert+ward");
  EXPECT_EQ(value_of(red, "rho_d", 0), 0.6);
  // Near the closed form sqrt(2/98), 4 pi a^2 Ks / pi: the best fit is a little wider.
  EXPECT_NEAR(value_of(red, "alpha", 0), std::sqrt(2 / 98.078), 0.01);
  EXPECT_NEAR(value_of(red, "rho_s", 1), 4 * 2 / 98.078 * 0.2, 1e-3);
  EXPECT_THAT(result.out, AllOf(HasSubstr("red_plastic.json"), HasSubstr("Red_Plastic_2.json")));
  EXPECT_THAT(red.conversion->from, HasSubstr("without the cosine"));
  EXPECT_THAT(red.provenance->table, HasSubstr("old.mtl"));
  EXPECT_EQ(red.provenance->sha256.size(), 64U);
  EXPECT_EQ(material::read_material(out / "ward/wall.json").model, "lambert");
  // Names that a file system may take for one: the second gets another.
  const auto blue = material::read_material(out / "ward/Red_Plastic_2.json");
  EXPECT_NEAR(value_of(blue, "rho_s", 2) / value_of(blue, "rho_s", 0), 3, 1e-9);
}

TEST(ConvertCommand, TakesTheExponentThatIsMissingFromTheUser) {
  const TemporaryFolder folder;
  const std::string path = folder.write("one.mtl", "newmtl a\nKd 0 0 0\nKs 1 1 1\n");
  EXPECT_EQ(run_gonio({"convert", path}).exit_status, 1);
  const auto result = run_gonio({"convert", path, "--default-exponent", "30", "--json"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json["materials"].size(), 1U);
  EXPECT_THAT(std::string(json["materials"][0]["conversion"]["from"]), HasSubstr("exponent 30"));
}

TEST(ConvertCommand, RefusesALibraryWithoutMaterialsOrAFolderThatIsAFile) {
  const TemporaryFolder folder;
  const auto empty = run_gonio({"convert", folder.write("empty.mtl", "# nothing\n")});
  EXPECT_EQ(empty.exit_status, 3);
  EXPECT_EQ(lines_of(empty.err).size(), 1U) << empty.err;
  const std::string file = folder.write("taken", "x");
  const auto taken = run_gonio({"convert", folder.write("old.mtl", library), "-o", file});
  EXPECT_EQ(taken.exit_status, 3);
  EXPECT_EQ(content_of(file), "x");
}

TEST(ConvertCommand, KeepsTheLettersOfANameAndItsNotes) {
  const TemporaryFolder folder;
  const TemporaryFolder out;
  const auto result = run_gonio({"convert",
                                 folder.write("one.mtl",
                                              "newmtl \xE9\x87\x91\xE5\xB1\x9E/..\nKd 1 1 1\n"
                                              "map_Kd gold.png\n"),
                                 "-o", out / "", "--json"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(out.names(), ElementsAre("\xE9\x87\x91\xE5\xB1\x9E_...json"));
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_THAT(json["materials"][0]["notes"].dump(), HasSubstr("map"));
  EXPECT_THAT(result.err, testing::Not(HasSubstr("times the light")));  // an albedo of 1 is allowed
}

constexpr std::string_view brass = R"({"format": "gonio-material", "version": 1, "name": "brass",
  "model": "ward-aniso", "channels": ["R", "G"], "parameters": {"rho_d": {"value": [0.1, 0.2]},
  "rho_s": {"value": [0.3, 0.2]}, "alpha_x": {"value": 0.05}, "alpha_y": {"value": 0.16}}})";

TEST(ConvertCommand, GivesTheFarPartnerOfALevelOfDetailPair) {
  const TemporaryFolder folder;
  const std::string far = folder / "far.json";
  const auto result = run_gonio({"convert", folder.write("brass.json", brass), "-o", far});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("lambert+ward-aniso"), HasSubstr("as lambert+blinn-phong")));
  const auto material = material::read_material(far);
  EXPECT_EQ(material.channels, (std::vector<std::string>{"R", "G"}));
  EXPECT_EQ(value_of(material, "rho_d", 1), 0.2);
  EXPECT_NEAR(value_of(material, "ks", 0) / value_of(material, "ks", 1), 1.5, 1e-9);
}

TEST(ConvertCommand, KeepsTheDiffuseTermBesideABareLobe) {
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "rough.json", R"({"format": "gonio-material", "version": 1, "model": "oren-nayar+ward",
      "channels": ["Y"], "parameters": {"rho_d": {"value": 0.4}, "sigma": {"value": 0.5},
      "rho_s": {"value": 0.1}, "alpha": {"value": 0.2}}})");
  const auto result = run_gonio({"convert", path, "--to", "blinn-phong", "--json"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["model"], "oren-nayar+blinn-phong");
  EXPECT_EQ(json["parameters"]["sigma"]["value"], 0.5);
  EXPECT_EQ(run_gonio({"convert", path, "-o", path}).exit_status, 2);
}

TEST(ConvertCommand, RefusesAMaterialOfANewerVersion) {
  const TemporaryFolder folder;
  std::string newer(brass);
  newer.replace(newer.find("\"version\": 1"), 12, "\"version\": 9");
  const auto result = run_gonio({"convert", folder.write("newer.json", newer)});
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_THAT(result.err, HasSubstr("newer"));
  EXPECT_EQ(lines_of(result.err).size(), 1U);
}

}  // namespace
}  // namespace gonio::tests
