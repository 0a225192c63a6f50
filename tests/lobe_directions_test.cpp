// The directions on which materials are compared: what they stand for adds up to what an integral
// gives, for lobes of any width.
#include "brdf/lobe_directions.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "brdf/albedo.h"
#include "brdf/model.h"

namespace gonio::brdf {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

TEST(LobeDirections, AreUnitVectorsAboveTheHorizonThatFillTheHemisphere) {
  for (const double theta_deg : {0.0, 15.0, 45.0, 75.0, 89.0}) {
    const auto wi = direction_from_degrees(theta_deg, 20);
    double sum = 0;
    for (const auto& [wo, solid_angle] : lobe_directions(wi)) {
      ASSERT_NEAR(std::hypot(wo.x, wo.y, wo.z), 1, 1e-14);
      ASSERT_GT(wo.z, 0);
      ASSERT_GT(solid_angle, 0);
      sum += solid_angle;
    }
    // 2 %: the ring that the horizon cuts counts whole or not at all, a tenth of ln t.
    EXPECT_NEAR(sum / (2 * std::numbers::pi), 1, 0.02) << theta_deg;
  }
}

TEST(LobeDirections, BeginWithTheMirrorDirection) {
  const auto wi = direction_from_degrees(40, 70);
  const auto first = lobe_directions(wi).front().direction;
  EXPECT_DOUBLE_EQ(first.x, -wi.x);
  EXPECT_DOUBLE_EQ(first.y, -wi.y);
  EXPECT_DOUBLE_EQ(first.z, wi.z);
}

TEST(LobeDirections, RefuseALightBelowTheHorizon) {
  EXPECT_THROW(lobe_directions({1, 0, 0}), std::invalid_argument);
  EXPECT_THROW(lobe_directions({0, 0, -1}), std::invalid_argument);
}

struct LobeCase {
  const char* model;
  std::vector<double> shape;
};

/// Adaptive quadrature to 1e-6 is the reference.
TEST(LobeDirections, SumToTheAlbedoOfALobeOfAnyWidth) {
  const std::vector<LobeCase> cases{
      {"ward-gmd", {1e-3}},        {"ward-gmd", {0.03}},  {"ward-gmd", {0.5}},
      {"ward-aniso", {0.05, 0.3}}, {"phong", {3}},        {"phong", {1e4}},
      {"blinn-phong", {1e5}},      {"oren-nayar", {0.5}}, {"lambert+ashikhmin-shirley", {200}}};
  for (const LobeCase& c : cases) {
    const Model model(c.model);
    for (const double theta_deg : {0.0, 30.0, 60.0, 75.0}) {
      const auto wi = direction_from_degrees(theta_deg, 35);
      std::vector<double> values(model.basis_size());
      std::vector<double> sums(model.basis_size());
      for (const auto& [wo, solid_angle] : lobe_directions(wi)) {
        model.basis(c.shape, wi, wo, values);
        for (std::size_t b = 0; b < sums.size(); ++b) sums[b] += values[b] * wo.z * solid_angle;
      }
      const Albedo albedo =
          basis_albedo(model, c.shape, theta_deg * radians_per_degree, 35 * radians_per_degree);
      for (std::size_t b = 0; b < sums.size(); ++b) {
        EXPECT_NEAR(sums[b], albedo.values[b], 2e-3 * albedo.values[b])
            << c.model << " basis " << b << " at " << theta_deg;
      }
    }
  }
}

}  // namespace
}  // namespace gonio::brdf
