// Pictures: the display curve, and files that other programs read.
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "render/image.h"
#include "render/image_file.h"
#include "render/tone.h"
#include "table/file_error.h"
#include "tests/run_gonio.h"

namespace gonio::render {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using tests::TemporaryFolder;

/// Numbers that no 16-bit float holds, and what is beyond the display.
Image sample_image() {
  return {3,
          2,
          {{0.1F, 0.2F, 0.3F, 1},
           {1.0F / 3, 7.0001F, 0, 1},
           {0.05F, 0.25F, 0.5F, 0.5F},
           {0, 0, 0, 0},
           {1e-7F, 12345.678F, 1, 1},
           {3e38F, 0, 0, 1}}};
}

template <class T>
std::vector<T> read_back(const std::string& path, OIIO::TypeDesc type, OIIO::ImageSpec& spec) {
  OIIO::ImageSpec as_stored;
  as_stored.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open(path, &as_stored);
  EXPECT_NE(input, nullptr) << OIIO::geterror();
  if (!input) return {};
  spec = input->spec();
  std::vector<T> values(spec.image_pixels() * std::size_t(spec.nchannels));
  EXPECT_TRUE(input->read_image(0, 0, 0, spec.nchannels, type, values.data())) << input->geterror();
  return values;
}

template <class Error>
std::string refusal(const std::string& path) {
  try {
    write_image(sample_image(), path);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SrgbCurve, IsThatOfTheStandard) {
  EXPECT_EQ(srgb_of(0), 0);
  EXPECT_NEAR(srgb_of(1), 1, 1e-15);
  EXPECT_DOUBLE_EQ(srgb_of(0.001), 0.01292);  // the straight part: slope 12.92
  // The inverse in closed form, with c = 0.5 of the display: ((0.5 + 0.055)/1.055)^2.4.
  EXPECT_NEAR(srgb_of(std::pow(0.555 / 1.055, 2.4)), 0.5, 1e-15);
  // The parts meet as well as the standard's rounded constants do.
  EXPECT_NEAR(srgb_of(0.0031308), srgb_of(std::nextafter(0.0031308, 1.0)), 1e-7);
  EXPECT_EQ(srgb_of(-1), 0);
  EXPECT_EQ(srgb_of(2), srgb_of(1));
}

TEST(DisplayPixels, TakeTheColourOfTheCoveredShare) {
  const auto display = display_pixels(sample_image(), 0);
  // Middle grey 0.18 is known as 118 of 255; here 0.1, 0.5 and 1 after division by alpha 0.5:
  // 255 (1.055 0.1^(1/2.4) - 0.055) = 89.06, 187.5, 255.
  EXPECT_THAT(display[2], ElementsAre(89, 188, 255, 128));
  EXPECT_THAT(display[3], ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(display[5], ElementsAre(255, 0, 0, 255));
  const Image grey{1, 1, {{0.18F, 0.18F, 0.18F, 1}}};
  EXPECT_THAT(display_pixels(grey, 0)[0], ElementsAre(118, 118, 118, 255));
}

TEST(DisplayPixels, ExposureIsInPowersOfTwo) {
  const Image dim{1, 1, {{0.045F, 0.045F, 0.72F, 1}}};
  const auto display = display_pixels(dim, 2);  // 0.045 2^2 = 0.18
  EXPECT_THAT(display[0], ElementsAre(118, 118, 255, 255));
}

TEST(Sheet, SetsImagesInRows) {
  const auto one = [](float value) { return Image{1, 1, {{value, value, value, 1}}}; };
  const std::vector<Image> images{one(1), one(2), one(3)};
  const Image whole = sheet(images, 2);
  EXPECT_EQ(whole.width, 2);
  EXPECT_EQ(whole.height, 2);
  EXPECT_EQ(whole.pixels[1][0], 2);
  EXPECT_EQ(whole.pixels[2][0], 3);
  EXPECT_EQ(whole.pixels[3], (Rgba{0, 0, 0, 0}));
  EXPECT_THROW(sheet({}, 2), std::invalid_argument);
  EXPECT_THROW(sheet(images, 0), std::invalid_argument);
  EXPECT_THROW(sheet(std::vector<Image>{one(1), sample_image()}, 1), std::invalid_argument);
}

TEST(Difference, IsTheAmplifiedMagnitude) {
  const Image a{1, 1, {{1, 2, 3, 1}}};
  const Image b{1, 1, {{1.5F, 1, 3, 0}}};
  EXPECT_EQ(difference(a, b, 8).pixels[0], (Rgba{4, 8, 0, 1}));
  EXPECT_EQ(largest_colour(difference(a, b, 8)), 8);
  EXPECT_THROW(difference(a, sample_image(), 1), std::invalid_argument);
}

TEST(ImageFile, ExrHoldsTheSameFloats) {
  const TemporaryFolder folder;
  const Image image = sample_image();
  write_image(image, folder / "s.exr", 3, {{"gonio:model", "ward"}});
  OIIO::ImageSpec spec;
  const auto values = read_back<float>(folder / "s.exr", OIIO::TypeDesc::FLOAT, spec);
  EXPECT_EQ(spec.width, 3);
  EXPECT_EQ(spec.height, 2);
  EXPECT_THAT(spec.channelnames, ElementsAre("R", "G", "B", "A"));
  EXPECT_EQ(spec.get_string_attribute("gonio:model"), "ward");
  ASSERT_EQ(values.size(), 24U);
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(values[i], image.pixels[i / 4][i % 4]) << i;
  }
}

TEST(ImageFile, PngHoldsTheDisplayPixels) {
  const TemporaryFolder folder;
  write_image(sample_image(), folder / "s.PNG", 1, {{"gonio:model", "ward"}});
  OIIO::ImageSpec spec;
  const auto values = read_back<std::uint8_t>(folder / "s.PNG", OIIO::TypeDesc::UINT8, spec);
  EXPECT_STREQ(spec.format.c_str(), "uint8");
  EXPECT_EQ(spec.get_string_attribute("gonio:model"), "ward");
  ASSERT_EQ(values.size(), 24U);
  const auto expected = display_pixels(sample_image(), 1);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], expected[i / 4][i % 4]) << i;
}

TEST(ImageFile, HasTheSameBytesAtAnyTime) {
  const TemporaryFolder folder;
  write_image(sample_image(), folder / "a.exr");
  sleep(1);  // what a time of day in the file would be told apart by
  write_image(sample_image(), folder / "b.exr");
  EXPECT_EQ(tests::content_of(folder / "a.exr"), tests::content_of(folder / "b.exr"));
}

TEST(ImageFile, SaysWhichFormatsThereAre) {
  EXPECT_THAT(refusal<std::invalid_argument>("ball.jpg"),
              testing::AllOf(HasSubstr("ball.jpg"), HasSubstr("'.jpg'"), HasSubstr(".exr"),
                             HasSubstr(".png")));
  EXPECT_THAT(refusal<std::invalid_argument>("ball"), HasSubstr("no extension"));
}

TEST(ImageFile, ThatCannotBeWrittenIsNamed) {
  const TemporaryFolder folder;
  const std::string path = folder / "absent/ball.png";
  EXPECT_THAT(refusal<table::FileError>(path), HasSubstr(path));
  EXPECT_THAT(folder.names(), ElementsAre());
}

}  // namespace
}  // namespace gonio::render
