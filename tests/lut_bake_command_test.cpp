// `gonio lut bake` as users meet it: the file, what is said of it, and bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lut/table_exr.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view brass = R"({"format": "gonio-material", "version": 1,
  "model": "ward-aniso", "channels": ["Y"], "parameters": {"rho_d": {"value": [0.1]},
  "rho_s": {"value": [0.33]}, "alpha_x": {"value": 0.05}, "alpha_y": {"value": 0.16}}})";

constexpr std::string_view chrome = R"({"format": "gonio-material", "version": 1,
  "model": "strauss-listing", "channels": ["Y"], "parameters": {"c": {"value": [0.5]},
  "s": {"value": 0.8}, "m": {"value": 1}, "t": {"value": 0.25}}})";

CommandResult bake(std::vector<std::string> arguments, const std::string& output) {
  arguments.insert(arguments.begin(), {"lut", "bake"});
  arguments.insert(arguments.end(), {"-o", output});
  return run_gonio(arguments);
}

TEST(LutBakeCommand, WritesTheMaterialsFirstTableAsFarAsItsLobeReaches) {
  const TemporaryFolder folder;
  const std::string path = folder / "brass.exr";
  const auto result = bake({folder.write("brass.json", brass)}, path);
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const lut::Table table = lut::table_from_exr(content_of(path));
  EXPECT_EQ(table.layout.kind, lut::TableKind::ward_exponent);
  EXPECT_EQ(table.layout.lowest, 0.05);
  EXPECT_EQ(table.layout.highest, 0.16);
  EXPECT_EQ(table.layout.reach, lut::lobe_reach(table.layout));
  EXPECT_EQ(table.layout.width, 512);
  EXPECT_EQ(table.texture.texels, lut::bake(table.layout).texture.texels);
  EXPECT_THAT(result.out, AllOf(HasSubstr(path), HasSubstr("ward-exponent"), HasSubstr("512 x 1"),
                                HasSubstr("2048 bytes"), HasSubstr("alpha 0.05 to 0.16"),
                                HasSubstr("* 511 + 0.5) / 512"), HasSubstr("w = 1 - n.h")));
}

TEST(LutBakeCommand, TakesTheArgumentAndTransparencyOfAStraussMaterial) {
  const TemporaryFolder folder;
  const std::string material = folder.write("chrome.json", chrome);
  const std::string path = folder / "chrome.exr";
  ASSERT_EQ(bake({material, "--size", "64"}, path).exit_status, 0);
  const lut::Table j = lut::table_from_exr(content_of(path));
  EXPECT_TRUE(j.layout.of_cosine);
  EXPECT_EQ(j.layout.height, 64);
  ASSERT_EQ(bake({material, "--table", "strauss-terms", "--size", "64x32"}, path).exit_status, 0);
  const lut::Table terms = lut::table_from_exr(content_of(path));
  EXPECT_EQ(terms.layout.transparency, 0.25);
  EXPECT_EQ(terms.layout.height, 32);
}

TEST(LutBakeCommand, BakesWithoutAMaterialWhatItsOptionsSay) {
  const TemporaryFolder folder;
  const std::string path = folder / "t.exr";
  const auto result =
      bake({"--table", "ward-lobe", "--alpha", "0.05:0.2", "--size", "128x16", "--coordinate",
            "fourth-root", "--format", "unorm16", "--reach", "0.25", "--json"},
           path);
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["file"], path);
  EXPECT_EQ(json["table"], "ward-lobe");
  EXPECT_EQ(json["coordinate"], "fourth-root");
  EXPECT_EQ(json["reach"], 0.25);
  EXPECT_EQ(json["width"], 128);
  EXPECT_EQ(json["height"], 16);
  EXPECT_EQ(json["lowest"], 0.05);
  EXPECT_EQ(json["highest"], 0.2);
  EXPECT_EQ(json["format"], "unorm16");
  EXPECT_EQ(json["bytes"], 128 * 16 * 2);
  const lut::Table table = lut::table_from_exr(content_of(path));
  EXPECT_EQ(table.layout.lowest, 0.05);
  EXPECT_EQ(table.layout.highest, 0.2);
  EXPECT_EQ(table.layout.storage, lut::Storage::unorm16);
}

// Over the cosine a table for 0.05 to 0.5 errs by 6 % of the peak, over fourth-root by 2.4e-4
// (docs/lut.md).
TEST(LutBakeCommand, ChoosesTheCoordinateByWhatIsServed) {
  const TemporaryFolder folder;
  const std::string path = folder / "t.exr";
  const auto coordinate_for = [&](const std::vector<std::string>& arguments) {
    const auto result = bake(arguments, path);
    EXPECT_EQ(result.exit_status, 0) << result.err;
    return lut::table_from_exr(content_of(path)).layout.coordinate;
  };
  using lut::Coordinate;
  EXPECT_EQ(coordinate_for({"--table", "ward-lobe", "--alpha", "0.1"}), Coordinate::cosine);
  EXPECT_EQ(coordinate_for({"--table", "ward-lobe", "--alpha", "0.05:0.5"}),
            Coordinate::fourth_root);
  EXPECT_EQ(coordinate_for({"--table", "ward-exponent"}), Coordinate::fourth_root);
  EXPECT_EQ(coordinate_for({"--table", "blinn-phong-power", "--exponent", "10:1000"}),
            Coordinate::fourth_root);
  EXPECT_EQ(coordinate_for({"--table", "strauss-j", "--size", "64"}), Coordinate::sqrt);
  EXPECT_EQ(coordinate_for({"--table", "strauss-terms", "--size", "64"}), Coordinate::cosine);
  EXPECT_EQ(coordinate_for({folder.write("brass.json", brass)}), Coordinate::fourth_root);
  EXPECT_EQ(
      coordinate_for({"--table", "ward-lobe", "--alpha", "0.05:0.5", "--coordinate", "cosine"}),
      Coordinate::cosine);
}

TEST(LutBakeCommand, ARangeMayBeWiderThanTheMaterials) {
  const TemporaryFolder folder;
  const std::string path = folder / "t.exr";
  const auto result = bake({folder.write("brass.json", brass), "--table", "ward-lobe", "--alpha",
                            "0.02:1", "--size", "128"},
                           path);
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const lut::Layout layout = lut::table_from_exr(content_of(path)).layout;
  EXPECT_EQ(layout.lowest, 0.02);
  EXPECT_EQ(layout.highest, 1);
  EXPECT_EQ(layout.height, lut::rows_of_a_range);
  EXPECT_EQ(layout.reach, lut::lobe_reach(layout));
}

// One that any alpha can be read from has to go to the horizon; so does the published one.
TEST(LutBakeCommand, AnExponentForEveryAlphaGoesToTheHorizon) {
  const TemporaryFolder folder;
  const std::string path = folder / "t.exr";
  for (const std::string coordinate : {"cosine", "listing"}) {
    ASSERT_EQ(bake({"--table", "ward-exponent", "--coordinate", coordinate}, path).exit_status, 0);
    EXPECT_EQ(lut::table_from_exr(content_of(path)).layout.reach, 1);
  }
}

struct BadUse {
  std::vector<std::string> arguments;
  std::string message;
};

TEST(LutBakeCommand, WrongUsageIsRefusedWithWhatIsPossible) {
  const TemporaryFolder folder;
  const std::string material = folder.write("brass.json", brass);
  const std::string paper =
      folder.write("paper.json", R"({"format": "gonio-material", "version": 1, "model": "lambert",
      "channels": ["Y"], "parameters": {"rho_d": {"value": [0.5]}}})");
  const std::vector<BadUse> uses{
      {{}, "--table ward-exponent, ward-lobe"},
      {{"--table", "teapot"}, "expected ward-exponent, ward-lobe"},
      {{material, "--table", "strauss-j"}, "expected ward-exponent or ward-lobe"},
      {{paper}, "the model lambert has no table"},
      {{material, "--size", "15"}, "16 to 4096"},
      {{material, "--size", "8192"}, "16 to 4096"},
      {{material, "--size", "64by64"}, "N or NxM"},
      {{material, "--size", "64.5"}, "N or NxM"},
      {{material, "--size", "64x"}, "--size: found '64x'"},
      {{"--table", "ward-lobe", "--alpha", "0.05:"}, "--alpha: found '0.05:'"},
      {{"--table", "ward-lobe", "--alpha", "0"}, "found alpha from 0 to 0"},
      {{material, "--coordinate", "angle"}, "listing, cosine, sqrt, fourth-root"},
      {{material, "--format", "r64f"}, "r32f, r16f, unorm16, unorm8"},
      {{material, "--reach", "half"}, "full, lobe"},
      {{material, "--reach", "0"}, "above 0 and at most 1"},
      {{material, "--alpha", "0.1"}, "a range with the material's 0.05 to 0.16"},
      {{material, "--alpha", "0.1:1"}, "a range with the material's 0.05 to 0.16"},
      {{material, "--exponent", "10"}, "does not depend on it"},
      {{material, "--t", "0.5"}, "the material says it"},
      {{"--table", "ward-lobe"}, "--alpha is missing"},
      {{"--table", "ward-exponent", "--format", "unorm8"}, "--alpha is missing"},
      {{"--table", "ward-exponent", "--format", "r16f"}, "--alpha is missing"},
      {{"--table", "ward-exponent", "--format", "r16f", "--alpha", "1e-4:10"}, "factor of 2000"},
      {{"--table", "ward-exponent", "--reach", "lobe"}, "a material or --alpha"},
      {{"--table", "ward-lobe", "--alpha", "0.2:0.1"}, "a range within 0.0001 to 10"},
      {{"--table", "ward-lobe", "--alpha", "nan"}, "a number or LOWEST:HIGHEST"},
      {{"--table", "blinn-phong-power", "--alpha", "0.1"}, "does not depend on it"},
      {{"--table", "strauss-j", "--model", "ward"}, "strauss or strauss-listing"},
      {{"--table", "strauss-terms", "--t", "2"}, "0 to 1"},
      {{"--table", "strauss-j", "--coordinate", "listing"}, "ward-exponent only"}};
  for (const BadUse& use : uses) {
    const auto result = bake(use.arguments, folder / "t.exr");
    EXPECT_EQ(result.exit_status, 2) << use.message;
    EXPECT_THAT(result.err, AllOf(HasSubstr("lut bake"), HasSubstr(use.message)));
    EXPECT_EQ(result.out, "");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "t.exr"));
  EXPECT_EQ(bake({material}, material).exit_status, 2) << "would overwrite its material";
}

TEST(LutBakeCommand, AnOptionThatSaysNothingIsRefused) {
  const TemporaryFolder folder;
  for (const std::string option : {"--table", "--size", "--coordinate", "--reach", "--format",
                                   "--alpha", "--exponent", "--t", "--model"}) {
    const auto result = bake({"--table", "ward-exponent", option, ""}, folder / "t.exr");
    EXPECT_EQ(result.exit_status, 2) << option;
    EXPECT_THAT(result.err, HasSubstr(option));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "t.exr"));
}

TEST(LutBakeCommand, AnExtensionOfAnotherFormatIsRefused) {
  const TemporaryFolder folder;
  for (const std::string name : {"t.png", "t", "t.exr.ktx"}) {
    const auto result = bake({"--table", "ward-exponent"}, folder / name);
    EXPECT_EQ(result.exit_status, 2) << name;
    EXPECT_THAT(result.err, AllOf(HasSubstr(name), HasSubstr("expected .exr")));
    EXPECT_FALSE(std::filesystem::exists(folder / name));
  }
}

TEST(LutBakeCommand, SaysWhichTermsAreReadAndWhichComputed) {
  const TemporaryFolder folder;
  const std::string material = folder.write("two.json",
                                            R"({"format": "gonio-material", "version": 1,
  "model": "lambert+ward+blinn-phong", "channels": ["Y"], "parameters": {"rho_d": {"value": [0.1]},
  "rho_s": {"value": [0.3]}, "alpha": {"value": 0.1}, "ks_2": {"value": [0.1]},
  "exponent_2": {"value": 20}}})");
  const auto text = bake({material}, folder / "t.exr");
  ASSERT_EQ(text.exit_status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("serves: ward; computed: lambert, blinn-phong\n"));
  const auto json = bake({material, "--table", "blinn-phong-power", "--json"}, folder / "t.exr");
  ASSERT_EQ(json.exit_status, 0) << json.err;
  const auto terms = nlohmann::json::parse(json.out)["terms"];
  EXPECT_EQ(terms["served"], nlohmann::json({"blinn-phong"}));
  EXPECT_EQ(terms["computed"], nlohmann::json({"lambert", "ward"}));
}

TEST(LutBakeCommand, AFolderThatTakesNoFileIsNamed) {
  const TemporaryFolder folder;
  const std::string gone = folder / "nowhere/t.exr";
  const auto missing = bake({"--table", "ward-exponent"}, gone);
  EXPECT_EQ(missing.exit_status, 3);
  EXPECT_THAT(missing.err, HasSubstr(gone));
}

// Not even root may make files in /proc.
TEST(LutBakeCommand, AReadOnlyFolderIsNamed) {
  const auto result = bake({"--table", "ward-exponent"}, "/proc/t.exr");
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_THAT(result.err, HasSubstr("/proc/t.exr"));
}

TEST(LutBakeCommand, AMaterialThatCannotBeReadIsNamed) {
  const TemporaryFolder folder;
  const auto result = bake({folder / "none.json"}, folder / "t.exr");
  EXPECT_EQ(result.exit_status, 3);
  EXPECT_THAT(result.err, HasSubstr("none.json"));
}

}  // namespace
}  // namespace gonio::tests
