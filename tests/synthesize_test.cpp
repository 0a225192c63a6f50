// The virtual gonioreflectometer: its geometry and its noise.
#include "instrument/synthesize.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "brdf/model.h"
#include "table/formats/gonio_csv.h"

namespace gonio::instrument {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

Recipe noise_free_brass() {
  Recipe r;
  r.name = "brass";
  r.model = "ward-aniso";
  r.channels = {"Y"};
  r.parameters = {{"rho_d", {0.1}}, {"rho_s", {0.33}}, {"alpha_x", {0.05}}, {"alpha_y", {0.16}}};
  r.incidence_angles_deg = {0, 40};
  r.sample_rotations_deg = {0, 30};
  r.hemisphere = {.theta_step_deg = 20, .phi_step_deg = 90};
  r.mirror_patch = MirrorPatch{.radius_step_deg = 2, .radius_max_deg = 4, .directions_per_ring = 6};
  return r;
}

double angle_between(const brdf::Direction<double>& a, const brdf::Direction<double>& b) {
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  const double z = a.z - b.z;
  return 2 * std::asin(std::sqrt(x * x + y * y + z * z) / 2) / radians_per_degree;
}

/// The sample's frame turned back to the laboratory's: phi_lab = phi + psi.
brdf::Direction<double> in_laboratory(const brdf::Direction<double>& d, double rotation_deg) {
  const double c = std::cos(rotation_deg * radians_per_degree);
  const double s = std::sin(rotation_deg * radians_per_degree);
  return {c * d.x - s * d.y, s * d.x + c * d.y, d.z};
}

// 1 pole and 4 rings of 4 azimuths up to 80 deg, then the mirror direction and 2 rings of 6.
constexpr std::size_t hemisphere_count = 17;
constexpr std::size_t patch_count = 13;
constexpr std::size_t position_count = hemisphere_count + patch_count;

TEST(SynthesizeTest, GoesThroughIncidenceRotationHemisphereAndPatch) {
  const auto t = synthesize(noise_free_brass());
  ASSERT_EQ(t.size(), 4 * position_count);
  const std::pair<double, double> positions[] = {{0, 0}, {0, 30}, {40, 0}, {40, 30}};
  for (std::size_t p = 0; p < 4; ++p) {
    const auto [theta_i, rotation] = positions[p];
    SCOPED_TRACE(fmt::format("theta_i {} rotation {}", theta_i, rotation));
    const std::size_t first = p * position_count;
    for (std::size_t i = first; i < first + position_count; ++i) {
      EXPECT_LT(
          angle_between(in_laboratory(t.wi[i], rotation), brdf::direction_from_degrees(theta_i, 0)),
          1e-5)
          << "the lamp stays at azimuth 0 of the laboratory";
    }
    const auto wo = [&, rotation = rotation](std::size_t k) {
      return in_laboratory(t.wo[first + k], rotation);
    };
    EXPECT_LT(angle_between(wo(0), {0, 0, 1}), 1e-5);
    EXPECT_LT(angle_between(wo(1), brdf::direction_from_degrees(20, 0)), 1e-5);
    EXPECT_LT(angle_between(wo(2), brdf::direction_from_degrees(20, 90)), 1e-5);
    EXPECT_LT(angle_between(wo(16), brdf::direction_from_degrees(80, 270)), 1e-5);
    const auto mirror = brdf::direction_from_degrees(theta_i, 180);
    for (std::size_t k = 0; k < patch_count; ++k) {
      const double radius = k == 0 ? 0 : k <= 6 ? 2 : 4;
      EXPECT_NEAR(angle_between(wo(hemisphere_count + k), mirror), radius, 1e-5);
    }
    // The first direction of a ring lies in the plane of incidence on the normal's side.
    EXPECT_LT(angle_between(wo(18), brdf::direction_from_degrees(theta_i - 2, 180)), 1e-5);
  }
}

TEST(SynthesizeTest, AnglesAreShortDecimalsThatNameTheDirectionsExactly) {
  Recipe recipe = noise_free_brass();
  recipe.incidence_angles_deg = {40};
  recipe.sample_rotations_deg = {30};
  const auto t = synthesize(recipe);
  EXPECT_EQ(t.angle_text[0], "40,330,0,330");
  EXPECT_EQ(t.angle_text[2], "40,330,20,60");
  EXPECT_EQ(t.angle_text[hemisphere_count], "40,330,40,150");
  for (std::size_t i = 0; i < t.size(); ++i) {
    double theta_i, phi_i, theta_o, phi_o;
    ASSERT_EQ(
        std::sscanf(t.angle_text[i].c_str(), "%lf,%lf,%lf,%lf", &theta_i, &phi_i, &theta_o, &phi_o),
        4);
    const auto wo = brdf::direction_from_degrees(theta_o, phi_o);
    EXPECT_EQ(t.wo[i].x, wo.x);
    EXPECT_EQ(t.wo[i].y, wo.y);
    EXPECT_EQ(t.wo[i].z, wo.z);
    EXPECT_LE(t.angle_text[i].size(), 2 + 3 + 2 * 10 + 3U) << t.angle_text[i];
    EXPECT_GE(phi_o, 0);
    EXPECT_LT(phi_o, 360);
  }
}

TEST(SynthesizeTest, TurningTheSampleTurnsTheLobe) {
  // Lamp and camera in one plane; after a quarter turn the brushing lies across it.
  Recipe recipe = noise_free_brass();
  recipe.incidence_angles_deg = {20};
  recipe.sample_rotations_deg = {0, 90};
  recipe.mirror_patch.reset();
  recipe.hemisphere = {.theta_step_deg = 10, .phi_step_deg = 180};
  const auto along = synthesize(recipe);
  std::swap(recipe.parameters["alpha_x"], recipe.parameters["alpha_y"]);
  const auto across = synthesize(recipe);
  const std::size_t half = along.size() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    EXPECT_NEAR(along.values[0][i + half] / across.values[0][i], 1, 1e-12);
  }
  EXPECT_NE(along.values[0][1], along.values[0][1 + half]);
}

TEST(SynthesizeTest, WithoutNoiseEveryValueIsTheModels) {
  const auto t = synthesize(noise_free_brass());
  const brdf::Model model("ward-aniso");
  for (std::size_t i = 0; i < t.size(); ++i) {
    EXPECT_EQ(t.values[0][i],
              model.evaluate(std::array{0.1, 0.33}, std::array{0.05, 0.16}, t.wi[i], t.wo[i]));
  }
  EXPECT_FALSE(t.has_sigma());
  EXPECT_EQ(t.provenance.format, "virtual gonioreflectometer");
  EXPECT_THAT(t.mask, testing::Each(table::MaskReason::none));
}

TEST(SynthesizeTest, SeesNothingBeyondThetaMaxNorAtTheHorizon) {
  Recipe recipe = noise_free_brass();
  recipe.incidence_angles_deg = {0, 70, 89.5};
  for (const double theta_max : {0.0, 60.0, 88.0, 90.0}) {
    recipe.theta_max_deg = theta_max;
    recipe.hemisphere = {.theta_step_deg = 30, .phi_step_deg = 90};
    const auto t = synthesize(recipe);
    double highest = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
      highest = std::max(highest, angle_between(t.wo[i], {0, 0, 1}));
    }
    EXPECT_LE(highest, std::min(theta_max, 90 - 1e-6) + 1e-9);
    EXPECT_GE(highest, std::min(theta_max, 88.0) - 3) << "the patches reach up to there";
  }
}

TEST(SynthesizeTest, StepsThatAreNoBinaryFractionsReachTheirEnd) {
  Recipe recipe = noise_free_brass();
  recipe.incidence_angles_deg = {0};
  recipe.sample_rotations_deg = {0};
  recipe.mirror_patch =
      MirrorPatch{.radius_step_deg = 0.1, .radius_max_deg = 0.3, .directions_per_ring = 1};
  recipe.hemisphere = {.theta_step_deg = 0.7, .phi_step_deg = 0.9};
  recipe.theta_max_deg = 2.1;
  const auto t = synthesize(recipe);
  EXPECT_EQ(t.size(), 1 + 3 * 400 + 1 + 3U);
  EXPECT_EQ(t.angle_text[1200], "0,0,2.1,359.1");
  EXPECT_EQ(t.angle_text[1204], "0,0,0.3,0");
}

/// Many readings of the same kind: a bright diffuse sample.
Recipe many_readings() {
  Recipe r;
  r.name = "white";
  r.model = "lambert";
  r.channels = {"A", "B"};
  r.parameters = {{"rho_d", {std::numbers::pi, std::numbers::pi / 2}}};  // f_r 1 and 0.5
  r.incidence_angles_deg = {60};
  r.sample_rotations_deg = {0};
  r.hemisphere = {.theta_step_deg = 0.5, .phi_step_deg = 1};  // 57,601 directions
  r.noise = {.relative = 0.1, .floor = 0.05, .seed = 3};
  r.sigma_columns = true;
  return r;
}

struct Moments {
  double mean, variance, excess;
};

Moments moments_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double second = 0;
  double fourth = 0;
  for (const double v : values) {
    second += (v - mean) * (v - mean) / n;
    fourth += std::pow(v - mean, 4) / n;
  }
  return {mean, second, fourth / (second * second) - 3};
}

TEST(SynthesizeTest, NoiseHasTheStatedDeviationAndIsNormal) {
  const auto t = synthesize(many_readings());
  const auto n = static_cast<double>(t.size());
  for (const auto& [channel, f_r] : {std::pair(0U, 1.0), std::pair(1U, 0.5)}) {
    const double variance = 0.01 * f_r * f_r + 0.0025;
    const Moments m = moments_of(t.values[channel]);
    // 4 standard errors: of a mean, a variance and a fourth moment of n normal numbers.
    EXPECT_NEAR(m.mean, f_r, 4 * std::sqrt(variance / n));
    EXPECT_NEAR(m.variance, variance, 4 * variance * std::sqrt(2 / n));
    EXPECT_NEAR(m.excess, 0, 4 * std::sqrt(24 / n));
    for (const double sigma : t.sigma[channel]) {
      ASSERT_NEAR(sigma, std::sqrt(variance), 1e-15);
    }
  }
}

TEST(SynthesizeTest, ReadingsAreIndependent) {
  const auto t = synthesize(many_readings());
  const auto n = static_cast<double>(t.size());
  double neighbours = 0;
  double channels = 0;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    const double a = (t.values[0][i] - 1) / t.sigma[0][i];
    neighbours += a * (t.values[0][i + 1] - 1) / t.sigma[0][i] / n;
    channels += a * (t.values[1][i] - 0.5) / t.sigma[1][i] / n;
  }
  EXPECT_NEAR(neighbours, 0, 4 / std::sqrt(n));
  EXPECT_NEAR(channels, 0, 4 / std::sqrt(n));
}

TEST(SynthesizeTest, NoiseIsAddedToTheDeclaredQuantity) {
  Recipe recipe = many_readings();
  recipe.noise.relative = 0;
  const auto brdf = synthesize(recipe);
  EXPECT_NEAR(brdf.sigma[0][0], 0.05, 1e-15);
  recipe.quantity = table::Quantity::brdf_cos;  // cos 60 deg = 1/2
  const auto cosine = synthesize(recipe);
  EXPECT_NEAR(cosine.sigma[0][0], 0.1, 1e-15);
  EXPECT_NEAR(cosine.values[0][0] - 1, 2 * (brdf.values[0][0] - 1), 1e-14);
  recipe.quantity = table::Quantity::reflectance_factor;
  EXPECT_NEAR(synthesize(recipe).sigma[0][0], 0.05 / std::numbers::pi, 1e-15);
}

TEST(SynthesizeTest, TheSeedDecidesTheNoise) {
  Recipe recipe = many_readings();
  const auto first = synthesize(recipe);
  EXPECT_EQ(synthesize(recipe).values, first.values);
  recipe.noise.seed = 4;
  EXPECT_NE(synthesize(recipe).values, first.values);
}

// The C++ standard fixes what std::mt19937_64 draws; the transform is the project's own.
TEST(SynthesizeTest, NoiseFollowsTheDocumentedTransform) {
  std::mt19937_64 generator(3);
  const double u1 = (static_cast<double>(generator() >> 12) + 0.5) / std::pow(2, 52);
  const double u2 = (static_cast<double>(generator() >> 12) + 0.5) / std::pow(2, 52);
  const double e1 = std::sqrt(-2 * std::log(u1)) * std::cos(2 * std::numbers::pi * u2);
  const double e2 = std::sqrt(-2 * std::log(u1)) * std::sin(2 * std::numbers::pi * u2);
  EXPECT_NEAR(synthesize(many_readings()).values[0][0], 1 * (1 + 0.1 * e1) + 0.05 * e2, 1e-14);
}

}  // namespace
}  // namespace gonio::instrument
