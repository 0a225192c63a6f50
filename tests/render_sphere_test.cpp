// Spheres: their shading against closed forms, whatever evaluates f_r.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "brdf/bound_model.h"
#include "lut/table.h"
#include "lut/table_model.h"
#include "render/reflectance.h"
#include "render/sphere.h"
#include "tests/vulkan_device_or_skip.h"

namespace gonio::render {
namespace {

constexpr RgbChannels in_order{0, 1, 2};

const std::array<double, 3> rho_d{0.8, 0.5, 0.2};

brdf::BoundModel lambert() {
  const std::array<brdf::NamedValues, 1> values{{{"rho_d", rho_d}}};
  return {brdf::Model("lambert"), 3, values};
}

brdf::BoundModel ward(double alpha_x, double alpha_y) {
  static const std::array<double, 3> rho_s{0.3, 0.2, 0.1};
  const std::array<brdf::NamedValues, 4> values{
      {{"rho_d", rho_d}, {"rho_s", rho_s}, {"alpha_x", {&alpha_x, 1}}, {"alpha_y", {&alpha_y, 1}}}};
  return {brdf::Model("ward-aniso"), 3, values};
}

Image picture(const brdf::BoundModel& model, const SphereView& view, int threads = 1) {
  return render_sphere(model_reflectance(model, in_order, threads), view);
}

const Rgba& pixel(const Image& image, int x, int y) {
  return image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
}

/// How far the pictures' colours are apart at most, over the largest radiance of the first.
double relative_difference(const Image& a, const Image& b) {
  return largest_colour(difference(a, b, 1)) / largest_colour(a);
}

/// The centre of the pixel on a unit sphere of the documented radius.
std::array<double, 3> normal_of(int x, int y, int size) {
  const double radius = 0.5 * size * sphere_radius;
  const double nx = (x + 0.5 - 0.5 * size) / radius;
  const double ny = -(y + 0.5 - 0.5 * size) / radius;
  return {nx, ny, std::sqrt(1 - nx * nx - ny * ny)};
}

/// The widths of the highlight about its brightest pixel, across and down, at half its height.
std::array<int, 2> highlight_widths(const Image& image) {
  const auto red = [&](int x, int y) { return double(pixel(image, x, y)[0]); };
  int peak_x = 0;
  int peak_y = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (red(x, y) > red(peak_x, peak_y)) {
        peak_x = x;
        peak_y = y;
      }
    }
  }
  std::array<int, 2> widths{};
  for (int i = 0; i < image.width; ++i) {
    widths[0] += red(i, peak_y) > red(peak_x, peak_y) / 2 ? 1 : 0;
    widths[1] += red(peak_x, i) > red(peak_x, peak_y) / 2 ? 1 : 0;
  }
  return widths;
}

TEST(RenderSphere, LambertHasTheRadianceOfItsCosine) {
  // Light from the upper right, towards the viewer: (0.48, 0.6, 0.64).
  const brdf::Direction<double> light{0.48, 0.6, 0.64};
  const SphereView view{.size = 64, .samples = 1, .lights = {light}};
  const Image image = picture(lambert(), view);
  int lit = 0;
  for (const auto& [x, y] : {std::pair{32, 32}, {50, 12}, {10, 30}, {31, 60}, {5, 40}, {58, 40}}) {
    const auto n = normal_of(x, y, 64);
    const double cosine = std::max(0.0, n[0] * light.x + n[1] * light.y + n[2] * light.z);
    lit += cosine > 0 ? 1 : 0;
    for (std::size_t c = 0; c < 3; ++c) {
      // E = pi and f_r = rho_d/pi: nothing but the cosine is left. A few roundings of a float.
      EXPECT_NEAR(pixel(image, x, y)[c], rho_d[c] * cosine, 2e-7) << x << ", " << y;
    }
    EXPECT_EQ(pixel(image, x, y)[3], 1);
  }
  // Two of them, the lowest and the leftmost one, are in the dark.
  EXPECT_EQ(lit, 4);
}

TEST(RenderSphere, FillsTheDocumentedDiscAndNothingElse) {
  const int size = 200;
  const Image image = picture(lambert(), {.size = size, .samples = 4});
  double covered = 0;
  for (const Rgba& value : image.pixels) covered += value[3];
  const double radius = 0.5 * size * sphere_radius;
  // The grid's error of a disc's area: far below one part in a thousand with 800 samples across.
  EXPECT_NEAR(covered / (std::numbers::pi * radius * radius), 1, 1e-3);
  EXPECT_EQ(pixel(image, 0, 0), (Rgba{0, 0, 0, 0}));
}

TEST(RenderSphere, LightsAddUp) {
  const auto left = brdf::direction_from_degrees(50, 180);
  const auto top = brdf::direction_from_degrees(30, 90);
  const auto model = ward(0.2, 0.3);
  const Image both = picture(model, {.size = 48, .samples = 2, .lights = {left, top}});
  const Image a = picture(model, {.size = 48, .samples = 2, .lights = {left}});
  const Image b = picture(model, {.size = 48, .samples = 2, .lights = {top}});
  for (std::size_t i = 0; i < both.pixels.size(); ++i) {
    const double sum = double(a.pixels[i][0]) + double(b.pixels[i][0]);
    EXPECT_NEAR(both.pixels[i][0], sum, 2e-7 * (1 + sum));
  }
}

TEST(RenderSphere, AlphaXIsAlongTheParallels) {
  const SphereView view{.size = 128, .lights = {{0, 0, 1}}};
  const auto upright = highlight_widths(picture(ward(0.05, 0.2), view));
  const auto level = highlight_widths(picture(ward(0.2, 0.05), view));
  // At half height the widths are as 1 to 4 but for the cosines and the bed of diffuse light.
  EXPECT_GT(upright[1], 2 * upright[0]);
  EXPECT_GT(level[0], 2 * level[1]);
}

TEST(RenderSphere, AQuarterTurnExchangesTheAxes) {
  const SphereView turned{.size = 96, .turn = std::numbers::pi / 2};
  const double apart =
      relative_difference(picture(ward(0.2, 0.05), turned), picture(ward(0.05, 0.2), {.size = 96}));
  // Directions in float: 6e-8 over alpha, times the lobe's steepest slope.
  EXPECT_LT(apart, 1e-5);
}

TEST(RenderSphere, HasTheSameBitsForAnyNumberOfThreads) {
  // Enough samples for several chunks.
  const SphereView view{.size = 90, .samples = 3};
  const Image one = picture(ward(0.1, 0.2), view, 1);
  EXPECT_EQ(one.pixels, picture(ward(0.1, 0.2), view, 2).pixels);
  EXPECT_EQ(one.pixels, picture(ward(0.1, 0.2), view, 5).pixels);
}

TEST(RenderSphere, IsTheSameInSeveralBatches) {
  // 2^20 pairs make a batch: 300 x 300 pixels of 16 samples and two lights are more than one.
  const auto light = brdf::direction_from_degrees(10, 0);
  const Image large = picture(lambert(), {.size = 300, .samples = 4, .lights = {light, light}});
  const Image single = picture(lambert(), {.size = 300, .samples = 4, .lights = {light}});
  for (std::size_t i = 0; i < large.pixels.size(); ++i) {
    ASSERT_NEAR(large.pixels[i][0], 2 * single.pixels[i][0], 1e-6);
  }
}

TEST(RenderSphere, RefusesWhatItCannotShow) {
  EXPECT_THROW(picture(lambert(), {.size = 0}), std::invalid_argument);
  EXPECT_THROW(picture(lambert(), {.size = largest_sphere + 1}), std::invalid_argument);
  EXPECT_THROW(picture(lambert(), {.samples = 0}), std::invalid_argument);
  EXPECT_THROW(picture(lambert(), {.lights = {}}), std::invalid_argument);
}

TEST(RenderSphere, StaysFiniteAtTheNarrowestLobe) {
  const Image image = picture(ward(1e-4, 1e-4), {.size = 64, .lights = {{0, 0, 1}}});
  for (const Rgba& value : image.pixels) {
    for (const float number : value) EXPECT_TRUE(std::isfinite(number) && number >= 0);
  }
}

TEST(RenderSphere, ADeviceShowsWhatTheCpuDoes) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const SphereView view{.size = 96, .samples = 2};
  for (const brdf::BoundModel& model : {lambert(), ward(0.1, 0.3)}) {
    const Image on_device = render_sphere(device_reflectance(device, model, in_order), view);
    // What the shader's float is off its double at most (docs/shaders.md).
    EXPECT_LT(relative_difference(picture(model, view), on_device), 2e-5);
  }
}

TEST(RenderSphere, AGoodTableShowsWhatTheModelDoesAndTheListingDoesNot) {
  const auto model = ward(0.05, 0.05);
  const SphereView view{.size = 96, .lights = {{0, 0, 1}}};
  const Image analytic = picture(model, view);
  const auto by_table = [&](lut::Coordinate coordinate) {
    lut::Layout layout = lut::layout_for(model, lut::TableKind::ward_exponent);
    layout.coordinate = coordinate;
    const lut::Table table = lut::bake(layout);
    const lut::TableModel table_model(model, table, lut::Filter::linear, lut::Weights::exact);
    return render_sphere(table_reflectance(table_model, 3, in_order, 1), view);
  };
  // 512 texels over all of n.h err by 6.1e-4 of the lobe's peak at alpha 0.05, the published
  // listing by 0.957 (docs/lut.md). The peak is pi 0.3/(4 pi 0.05^2) of radiance; the brightest
  // pixel, a mean over some of the lobe, does not show all that the listing loses of it.
  const double peak = 0.3 / (4 * 0.05 * 0.05);
  EXPECT_LT(largest_colour(difference(analytic, by_table(lut::Coordinate::cosine), 1)),
            6.1e-4 * peak);
  EXPECT_GT(largest_colour(difference(analytic, by_table(lut::Coordinate::listing), 1)),
            0.8 * peak);
}

TEST(RenderSphere, ATableOnADeviceShowsWhatItDoesOnTheCpu) {
  GONIO_VULKAN_DEVICE_OR_SKIP(device);
  const auto model = ward(0.1, 0.1);
  const SphereView view{.size = 96, .samples = 2};
  const lut::Table table = lut::bake(lut::layout_for(model, lut::TableKind::ward_exponent));
  const lut::TableModel table_model(model, table, lut::Filter::linear, lut::Weights::exact);
  const Image on_cpu = render_sphere(table_reflectance(table_model, 3, in_order, 1), view);
  const Image on_device =
      render_sphere(device_reflectance(device, model, in_order, shader::TableUse{table}), view);
  // A GPU rounds the filter's weight to 1/256 of a texel: half a step of a texel, 1/512 wide in
  // n.h, is 1/(512 256 2 alpha^2) of the exponent.
  EXPECT_LT(relative_difference(on_cpu, on_device), 1 / (512.0 * 256 * 2 * 0.01));
}

}  // namespace
}  // namespace gonio::render
