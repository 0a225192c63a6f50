// The solid angle that a node of a grid stands for, against what the whole grid covers.
#include "table/solid_angle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace gonio::tests {
namespace {

constexpr double pi = std::numbers::pi;

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(SolidAngle, ZenithsFromThePoleToTheHorizonCoverTheHemisphere) {
  std::vector<double> theta;
  for (int k = 0; k <= 18; ++k) theta.push_back(k * pi / 36);
  const std::vector<double> measures = table::zenith_measures(theta, pi / 2);
  EXPECT_NEAR(sum(measures), 1, 1e-14);  // cos 0 - cos 90 deg
  // The cell of 45 deg, from 42.5 to 47.5 deg.
  EXPECT_NEAR(measures[9], std::cos(42.5 * pi / 180) - std::cos(47.5 * pi / 180), 1e-15);
  EXPECT_NEAR(measures[0], 1 - std::cos(2.5 * pi / 180), 1e-15);
}

TEST(SolidAngle, ADenserPartOfAGridWeighsNoMore) {
  std::vector<double> theta;
  for (double degrees = 0; degrees < 30; degrees += 5) theta.push_back(degrees * pi / 180);
  for (double degrees = 30; degrees < 60; degrees += 1) theta.push_back(degrees * pi / 180);
  for (double degrees = 60; degrees <= 90; degrees += 5) theta.push_back(degrees * pi / 180);
  const std::vector<double> measures = table::zenith_measures(theta, pi / 2);
  EXPECT_NEAR(sum(measures), 1, 1e-14);
  // The integral of cos(theta) over the hemisphere per azimuth is 1/2, to the grid's step.
  double integral = 0;
  for (std::size_t k = 0; k < theta.size(); ++k) integral += measures[k] * std::cos(theta[k]);
  EXPECT_NEAR(integral, 0.5, 1e-3);
}

TEST(SolidAngle, BothEndsOfAWholeCircleAreOneNode) {
  std::vector<double> phi;
  for (int k = 0; k <= 36; ++k) phi.push_back(k * pi / 18);
  const std::vector<double> measures = table::azimuth_measures(phi);
  EXPECT_NEAR(sum(measures), 2 * pi, 1e-14);
  EXPECT_NEAR(measures.front() + measures.back(), measures[5], 1e-14);
  phi.pop_back();
  EXPECT_NEAR(sum(table::azimuth_measures(phi)), 2 * pi, 1e-14);
}

TEST(SolidAngle, ASingleNodeIsWeighedAgainstNothing) {
  EXPECT_THAT(table::zenith_measures(std::vector<double>{0.3}, pi / 2), testing::ElementsAre(1.0));
  EXPECT_THAT(table::azimuth_measures(std::vector<double>{0.3}), testing::ElementsAre(1.0));
  EXPECT_TRUE(table::zenith_measures({}, pi / 2).empty());
}

}  // namespace
}  // namespace gonio::tests
