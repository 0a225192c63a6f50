// What `gonio render` writes and prints, and what it refuses.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr std::string_view glossy = R"({
  "format": "gonio-material", "version": 1, "name": "glossy", "model": "ward",
  "channels": ["R", "G", "B"],
  "parameters": {"rho_d": {"value": [0.2, 0.1, 0.05]}, "rho_s": {"value": [0.05, 0.05, 0.05]},
                 "alpha": {"value": 0.05}}})";

constexpr std::string_view chalk = R"({
  "format": "gonio-material", "version": 1, "model": "lambert", "channels": ["465nm", "630nm", "525nm"],
  "parameters": {"rho_d": {"value": [0.25, 1, 0.5]}}})";

struct Picture {
  int width = 0;
  int height = 0;
  std::vector<float> rgba;

  std::vector<float> at(int x, int y) const {
    const auto first = rgba.begin() + 4 * (std::ptrdiff_t{y} * width + x);
    return {first, first + 4};
  }
};

Picture picture_in(const std::string& path) {
  const auto input = OIIO::ImageInput::open(path);
  EXPECT_NE(input, nullptr) << OIIO::geterror();
  if (!input) return {};
  Picture picture{input->spec().width, input->spec().height, {}};
  EXPECT_EQ(input->spec().nchannels, 4);
  picture.rgba.resize(input->spec().image_pixels() * 4);
  EXPECT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, picture.rgba.data()));
  return picture;
}

/// The arguments of a small picture on the CPU.
std::vector<std::string> small(const std::vector<std::string>& materials, const std::string& output,
                               const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"render", "-o", output, "--pixels", "33", "--device", "cpu"};
  arguments.insert(arguments.end(), materials.begin(), materials.end());
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(RenderCommand, ShowsWavelengthsAsTheirColours) {
  const TemporaryFolder folder;
  const std::string material = folder.write("chalk.json", chalk);
  const auto result =
      run_gonio(small({material}, folder / "chalk.exr", {"--light", "0,0", "--samples", "1"}));
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("33 x 33"), HasSubstr("the CPU, as asked")));
  // The middle faces viewer and light: radiance is rho_d.
  EXPECT_THAT(picture_in(folder / "chalk.exr").at(16, 16),
              testing::Pointwise(testing::FloatNear(1e-6F), {1.0F, 0.5F, 0.25F, 1.0F}));
}

TEST(RenderCommand, SetsSpheresInRows) {
  const TemporaryFolder folder;
  const std::string a = folder.write("chalk.json", chalk);
  const std::string b = folder.write("glossy.json", glossy);
  const auto result =
      run_gonio(small({a, b, a}, folder / "sheet.png", {"--columns", "2", "--json"}));
  EXPECT_EQ(result.exit_status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["width"], 66);
  EXPECT_EQ(json["height"], 66);
  ASSERT_EQ(json["spheres"].size(), 3U);
  EXPECT_EQ(json["spheres"][1]["material"], "glossy");
  EXPECT_EQ(json["spheres"][1]["model"], "lambert+ward");
  const Picture picture = picture_in(folder / "sheet.png");
  EXPECT_EQ(picture.width, 66);
  EXPECT_EQ(picture.at(16, 16)[3], 1);  // the first sphere
  EXPECT_EQ(picture.at(49, 49)[3], 0);  // nothing in the last place
}

TEST(RenderCommand, TellsTheErrorOfATable) {
  const TemporaryFolder folder;
  const std::string material = folder.write("glossy.json", glossy);
  const auto table_error = [&](const std::string& coordinate) -> double {
    const auto result =
        run_gonio(small({material}, folder / "difference.exr",
                        {"--table", "ward-exponent", "--coordinate", coordinate, "--reach", "full",
                         "--difference", "10", "--light", "0,0", "--json"}));
    EXPECT_EQ(result.exit_status, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    const double error = json["spheres"][0]["table_error"];
    const Picture picture = picture_in(folder / "difference.exr");
    float largest = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
      if (i % 4 != 3) largest = std::max(largest, picture.rgba[i]);
    }
    EXPECT_GT(largest, 0);
    // What is shown is ten times the error of the largest radiance, which is below the 5.2 of lobe
    // and diffuse light, and at this size of a pixel above half of that.
    EXPECT_LT(largest, 10 * error * 5.21);
    EXPECT_GT(largest, 10 * error * 2.6);
    return error;
  };
  // docs/lut.md: 0.957 and 6.1e-4 of the lobe's peak. A pixel of a picture as small as this one is
  // as large as the lobe, and shows of them what it averages.
  EXPECT_GT(table_error("listing"), 0.5);
  EXPECT_LT(table_error("cosine"), 6.1e-4 * 2);
}

TEST(RenderCommand, ShowsTheTable) {
  const TemporaryFolder folder;
  const std::string material = folder.write("glossy.json", glossy);
  const std::vector<std::string> frontal{"--light", "0,0"};
  ASSERT_EQ(run_gonio(small({material}, folder / "model.exr", frontal)).exit_status, 0);
  ASSERT_EQ(
      run_gonio(small({material}, folder / "table.exr",
                      {"--light", "0,0", "--table", "ward-exponent", "--coordinate", "listing"}))
          .exit_status,
      0);
  // The listing loses most of this highlight, and nothing beside it.
  const Picture model = picture_in(folder / "model.exr");
  const Picture table = picture_in(folder / "table.exr");
  EXPECT_LT(table.at(16, 16)[0], 0.5 * model.at(16, 16)[0]);
  EXPECT_NEAR(table.at(4, 16)[0], model.at(4, 16)[0], 1e-6);
}

TEST(RenderCommand, WorksWithoutVulkanAndSaysSo) {
  const TemporaryFolder folder;
  const std::string material = folder.write("glossy.json", glossy);
  const RunOptions none{.environment = {{"VK_DRIVER_FILES", folder / "none.json"},
                                        {"VK_ICD_FILENAMES", folder / "none.json"}}};
  const auto result =
      run_gonio({"render", material, "-o", folder / "ball.png", "--pixels", "16"}, none);
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("evaluated by the CPU: no Vulkan"));
  const auto asked =
      run_gonio({"render", material, "-o", folder / "other.png", "--device", "llvmpipe"}, none);
  EXPECT_EQ(asked.exit_status, 3);
  EXPECT_THAT(asked.err, HasSubstr("--device cpu"));
  EXPECT_THAT(folder.names(), Not(testing::Contains("other.png")));
}

TEST(RenderCommand, RefusesWrongUsage) {
  const TemporaryFolder folder;
  const std::string material = folder.write("glossy.json", glossy);
  const auto refusal = [&](const std::string& output, const std::vector<std::string>& more = {}) {
    const auto result = run_gonio(small({material}, output, more));
    EXPECT_EQ(result.exit_status, 2) << result.err;
    return result.err;
  };
  const std::string png = folder / "ball.png";
  EXPECT_THAT(refusal(folder / "ball.jpg"), AllOf(HasSubstr(".exr"), HasSubstr(".png")));
  EXPECT_THAT(refusal(png, {"--light", "30"}), HasSubstr("THETA,PHI"));
  EXPECT_THAT(refusal(png, {"--light", "181,0"}), HasSubstr("0 to 180"));
  EXPECT_THAT(refusal(png, {"--exposure", "nan"}), HasSubstr("--exposure nan"));
  EXPECT_THAT(refusal(png, {"--samples", "0"}), HasSubstr("--samples"));
  EXPECT_THAT(refusal(png, {"--size", "512"}), AllOf(HasSubstr("--table"), HasSubstr("--pixels")));
  EXPECT_THAT(refusal(png, {"--difference", "2"}), HasSubstr("--table"));
  EXPECT_THAT(refusal(png, {"--table", "strauss-j"}),
              AllOf(HasSubstr("strauss-j"), HasSubstr("expected ward-exponent")));
  EXPECT_THAT(folder.names(), ElementsAre("glossy.json"));
}

TEST(RenderCommand, RefusesWhatItCannotReadOrWrite) {
  const TemporaryFolder folder;
  const std::string material = folder.write("glossy.json", glossy);
  const auto into_nothing = run_gonio(small({material}, folder / "absent/ball.png"));
  EXPECT_EQ(into_nothing.exit_status, 3);
  EXPECT_THAT(into_nothing.err, HasSubstr("absent/ball.png"));
  const std::string four =
      folder.write("four.json", R"({"format": "gonio-material", "version": 1, "model": "lambert",
                       "channels": ["a", "b", "c", "d"],
                       "parameters": {"rho_d": {"value": [0, 0, 0, 0]}}})");
  const auto colours = run_gonio(small({four}, folder / "ball.png"));
  EXPECT_EQ(colours.exit_status, 3);
  EXPECT_THAT(colours.err, HasSubstr("expected R, G and B"));
}

}  // namespace
}  // namespace gonio::tests
