// gonio lut check as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/fit_command.h"
#include "tests/run_gonio.h"
#include "tests/vulkan_device_or_skip.h"

namespace gonio::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// No driver is found: what a machine without Vulkan is like.
const RunOptions without_vulkan{
    .environment = {{"VK_DRIVER_FILES", "/nowhere.json"}, {"VK_ICD_FILENAMES", "/nowhere.json"}}};

class LutCheckCommand : public testing::Test {
 protected:
  LutCheckCommand() { EXPECT_EQ(fit({plastic, "-m", "ward", "-o", fitted}).exit_status, 0); }

  static CommandResult check(std::vector<std::string> arguments, const RunOptions& options = {}) {
    arguments.insert(arguments.begin(), {"lut", "check"});
    return run_gonio(arguments, options);
  }
  nlohmann::json checked(std::vector<std::string> arguments, int exit_status) const {
    arguments.insert(arguments.begin(), fitted);
    arguments.emplace_back("--json");
    const CommandResult result = check(arguments);
    EXPECT_EQ(result.exit_status, exit_status) << result.err;
    return nlohmann::json::parse(result.out);
  }
  std::string hand_written(const std::string& model, const std::string& parameters) const {
    return folder.write("hand.json", R"({"format": "gonio-material", "version": 1, "model": ")" +
                                         model + R"(", "channels": ["Y"], "parameters": )" +
                                         parameters + "}");
  }

  TemporaryFolder folder;
  std::string fitted = folder / "fitted.json";
};

TEST_F(LutCheckCommand, SaysThatThePublishedTableIsTheWeakerPart) {
  const nlohmann::json json = checked({"--coordinate", "listing", "--device", "cpu"}, 1);
  // Between the published errors at alpha 0.1 and 0.2, .544 and .178: this one has 0.13.
  const double largest = json.at("errors").at("predicted").at("largest_of_peak");
  EXPECT_LT(largest, 0.544);
  EXPECT_GT(largest, 0.178);
  EXPECT_GT(json.at("share_of_residual"), 1);
  EXPECT_FALSE(json.at("within_tolerance"));
  EXPECT_TRUE(json.at("errors").at("measured").is_null()) << "the CPU measures nothing";
  const CommandResult text = check({fitted, "--coordinate", "listing", "--device", "cpu"});
  EXPECT_THAT(text.out, AllOf(HasSubstr("the table is the weaker part"), HasSubstr("PAST")));
}

TEST_F(LutCheckCommand, RecommendsATableUnderOnePercentOfTheResidualAndTheCommandForIt) {
  const nlohmann::json json = checked({"--recommend", "--device", "cpu"}, 0);
  EXPECT_LT(json.at("share_of_residual"), 0.01);
  EXPECT_TRUE(json.at("within_tolerance"));
  const nlohmann::json& first = json.at("recommended").at(0);
  EXPECT_EQ(first.at("bytes"), json.at("table").at("bytes"));
  for (const nlohmann::json& other : json.at("recommended")) {
    EXPECT_LE(first.at("bytes"), other.at("bytes"));
  }
  // The table that its options describe is the one that was recommended.
  const std::vector<std::string> words = split(first.at("command").get<std::string>(), ' ');
  ASSERT_EQ(words.at(2), "bake");
  const std::vector<std::string> options(words.begin() + 4, words.end() - 2);
  std::vector<std::string> again = options;
  again.insert(again.end(), {"--device", "cpu", "--filter", first.at("filter")});
  EXPECT_EQ(checked(again, 0).at("table"), json.at("table"));
}

TEST_F(LutCheckCommand, MeasuresOnTheDeviceThatThereIs) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const nlohmann::json json = checked({"--device", device.description().name}, 0);
  EXPECT_THAT(json.at("device"), HasSubstr(device.description().name));
  EXPECT_LE(json.at("errors").at("analytic").at("largest_of_peak"), 2e-5);
  EXPECT_GT(json.at("errors").at("measured").at("largest_of_peak"), 0);
}

TEST_F(LutCheckCommand, RecommendsOnlyWhatTheDeviceReadsWithinTheTolerance) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  // Lavapipe filters 8 bits with 8 bits: of the 16 bytes that are predicted to be enough for so
  // wide a lobe it makes 3e-3 of the peak.
  const std::string path = hand_written(
      "ward-duer",
      R"({"rho_d": {"value": [0.1]}, "rho_s": {"value": [0.2]}, "alpha": {"value": 10}})");
  const CommandResult result =
      check({path, "--recommend", "--json", "--device", device.description().name});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  const double tolerance = json.at("tolerance");
  EXPECT_LE(json.at("errors").at("measured").at("largest_of_peak"), tolerance);
  for (const nlohmann::json& table : json.at("passed_over")) {
    EXPECT_GT(table.at("measured").at("largest_of_peak"), tolerance);
  }
}

TEST_F(LutCheckCommand, DoesTheWorkOnTheCpuWithoutAnyVulkanDeviceAndSaysSo) {
  const CommandResult result = check({fitted}, without_vulkan);
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("device: the CPU: "), HasSubstr("table, predicted"),
                    HasSubstr("of the peak, predicted"), Not(HasSubstr("with the table"))));
  const CommandResult named = check({fitted, "--device", "llvmpipe"}, without_vulkan);
  EXPECT_EQ(named.exit_status, 3);
  EXPECT_THAT(named.err, AllOf(HasSubstr("--device llvmpipe"), HasSubstr("--device cpu")));
}

TEST_F(LutCheckCommand, TakesTheSamplesOfTheFitUnlessTheyChanged) {
  EXPECT_EQ(checked({"--device", "cpu"}, 0).at("directions").at("samples"), 1696);
  const std::string copy = folder.write("copy.csv", content_of(plastic));
  EXPECT_EQ(fit({copy, "-m", "ward", "-o", fitted}).exit_status, 0);
  EXPECT_EQ(checked({"--device", "cpu"}, 0).at("directions").at("table"), copy);
  folder.write("copy.csv", content_of(plastic) + "# another one\n");
  const CommandResult changed = check({fitted, "--device", "cpu"});
  EXPECT_THAT(changed.out, AllOf(HasSubstr("has changed"), HasSubstr("by the material's file")));
  const nlohmann::json all_the_same = checked({"--device", "cpu", "--samples", copy}, 0);
  EXPECT_EQ(all_the_same.at("directions").at("samples"), 1696);
}

TEST_F(LutCheckCommand, ChecksAMaterialThatWasNotFitted) {
  const std::string path = hand_written(
      "ward",
      R"({"rho_d": {"value": [0.1]}, "rho_s": {"value": [0.2]}, "alpha": {"value": 0.05}})");
  const CommandResult result = check({path, "--device", "cpu"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("not fitted"), HasSubstr("There is no fit's residual")));
}

TEST_F(LutCheckCommand, FailsPastTheTolerance) {
  checked({"--size", "64", "--device", "cpu", "--tolerance", "0.01"}, 0);
  checked({"--size", "64", "--device", "cpu", "--tolerance", "1e-6"}, 1);
  const CommandResult none = check({fitted, "--recommend", "--tolerance", "1e-9"});
  EXPECT_EQ(none.exit_status, 1);
  EXPECT_THAT(none.out, HasSubstr("No table"));
}

TEST_F(LutCheckCommand, RecommendsByTheToleranceAloneWithoutSamplesAndSaysSo) {
  const CommandResult gone =
      check({fitted, "--recommend", "--device", "cpu", "--samples", plastic});
  EXPECT_THAT(gone.out, Not(HasSubstr("alone")));
  const std::string copy = folder.write("copy.csv", content_of(plastic));
  EXPECT_EQ(fit({copy, "-m", "ward", "-o", fitted}).exit_status, 0);
  folder.write("copy.csv", content_of(plastic) + "# another one\n");
  const CommandResult result = check({fitted, "--recommend", "--device", "cpu"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("The tolerance alone decides: there are no samples"),
                                HasSubstr("not strictly comparable")));
  EXPECT_EQ(checked({"--device", "cpu"}, 0).at("fit").at("residual_use"), "over other directions");
}

TEST_F(LutCheckCommand, NamesTheLimitThatNoTableKeeps) {
  const CommandResult none = check({fitted, "--recommend", "--tolerance", "1e-9"});
  EXPECT_THAT(none.out, HasSubstr("the tolerance is what none keeps"));
}

TEST_F(LutCheckCommand, JudgesATableThatWasBaked) {
  const std::string path = folder / "table.exr";
  const std::vector<std::string> options{"--size",  "64",           "--format",
                                         "unorm16", "--coordinate", "sqrt"};
  std::vector<std::string> bake{"lut", "bake", fitted, "-o", path};
  bake.insert(bake.end(), options.begin(), options.end());
  ASSERT_EQ(run_gonio(bake).exit_status, 0);
  std::vector<std::string> described = options;
  described.insert(described.end(), {"--device", "cpu"});
  nlohmann::json expected = checked(described, 0);
  expected["table"]["file"] = path;
  EXPECT_EQ(checked({"--lut", path, "--device", "cpu"}, 0), expected);
  const CommandResult text = check({fitted, "--lut", path, "--device", "cpu"});
  EXPECT_THAT(text.out, HasSubstr(path));
}

TEST_F(LutCheckCommand, RefusesABakedTableThatIsNoneOrAnothers) {
  const CommandResult missing = check({fitted, "--lut", folder / "none.exr"});
  EXPECT_EQ(missing.exit_status, 3);
  EXPECT_THAT(missing.err, HasSubstr("none.exr"));
  const std::string broken = folder.write("broken.exr", "not a table");
  const CommandResult unreadable = check({fitted, "--lut", broken});
  EXPECT_EQ(unreadable.exit_status, 3);
  EXPECT_THAT(unreadable.err, HasSubstr(broken));
  const std::string power = folder / "power.exr";
  ASSERT_EQ(
      run_gonio({"lut", "bake", "--table", "blinn-phong-power", "--exponent", "50", "-o", power})
          .exit_status,
      0);
  const CommandResult other = check({fitted, "--lut", power});
  EXPECT_EQ(other.exit_status, 2);
  EXPECT_THAT(other.err, AllOf(HasSubstr(power), HasSubstr("ward-exponent or ward-lobe")));
}

struct Refusal {
  std::vector<std::string> arguments;
  std::string message;
};

TEST_F(LutCheckCommand, RefusesWhatItCannotDo) {
  const std::vector<Refusal> refusals{{{"--table", "strauss-j"}, "ward-exponent"},
                                      {{"--size", "5000"}, "4096"},
                                      {{"--filter", "cubic"}, "expected nearest, linear"},
                                      {{"--tolerance", "0"}, "above 0"},
                                      {{"--max-theta", "91"}, "at most 90"},
                                      {{"--recommend", "--size", "64"}, "--recommend chooses"},
                                      {{"--lut", "a.exr", "--size", "64"}, "--lut names"},
                                      {{"--lut", "a.exr", "--recommend"}, "--recommend chooses"},
                                      {{"--coordinate", "listing", "--format", "unorm8"}, "r32f"}};
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.arguments.front());
    std::vector<std::string> arguments{fitted, "--device", "cpu"};
    arguments.insert(arguments.end(), refusal.arguments.begin(), refusal.arguments.end());
    const CommandResult result = check(arguments);
    EXPECT_EQ(result.exit_status, 2) << result.out;
    EXPECT_THAT(result.err, HasSubstr(refusal.message));
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(LutCheckCommand, SaysWhichModelsHaveTables) {
  const std::string path = hand_written("lambert", R"({"rho_d": {"value": [0.5]}})");
  const CommandResult result = check({path, "--device", "cpu"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr(path), HasSubstr("no table"), HasSubstr("blinn-phong")));
}

TEST_F(LutCheckCommand, RefusesSamplesThatAreNotTheMaterials) {
  const CommandResult missing = check({fitted, "--samples", folder / "none.csv"});
  EXPECT_EQ(missing.exit_status, 3);
  EXPECT_THAT(missing.err, HasSubstr("none.csv"));
}

}  // namespace
}  // namespace gonio::tests
