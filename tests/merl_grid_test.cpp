// Rusinkiewicz's coordinates, and the bins of MERL's grid.
#include "table/formats/merl_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <utility>

#include "table/formats/half_difference.h"
#include "tests/merl_reference.h"

namespace gonio::tests {
namespace {

using brdf::Direction;
using brdf::DirectionPair;
using merl_reference::any_direction;
using merl_reference::described_bin;
using merl_reference::turned_to_the_normal;
using table::HalfDifference;
using table::MerlGrid;

constexpr double pi = std::numbers::pi;

TEST(HalfDifference, IsWiInTheFrameOfTheHalfVector) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Direction<double> wi = any_direction(random);
    const Direction<double> wo = any_direction(random);
    const HalfDifference expected = turned_to_the_normal(wi, wo);
    const HalfDifference found = table::half_difference(wi, wo, 0);
    // acos near its ends costs the definition half the digits.
    EXPECT_NEAR(found.theta_h, expected.theta_h, 1e-7);
    EXPECT_NEAR(found.theta_d, expected.theta_d, 1e-7);
    EXPECT_NEAR(std::remainder(found.phi_h - expected.phi_h, 2 * pi), 0, 1e-12);
    EXPECT_NEAR(std::remainder(found.phi_d - expected.phi_d, 2 * pi), 0, 1e-9);
    const DirectionPair<double> back = table::directions_from(found);
    for (const auto& [a, b] : {std::pair{back.wi, wi}, std::pair{back.wo, wo}}) {
      EXPECT_NEAR(a.x, b.x, 1e-15);
      EXPECT_NEAR(a.y, b.y, 1e-15);
      EXPECT_NEAR(a.z, b.z, 1e-15);
    }
  }
}

TEST(HalfDifference, AtTheNormalTheAzimuthOfHIsZero) {
  // h of a mirrored pair is the normal but for rounding, which would give it any azimuth.
  const Direction<double> wi = brdf::direction_from_degrees(30, 77);
  const Direction<double> wo = brdf::direction_from_degrees(30, 257);
  const HalfDifference found = table::half_difference(wi, wo, 1e-12);
  EXPECT_EQ(found.phi_h, 0);
  EXPECT_NEAR(found.phi_d, 77 * pi / 180, 1e-14);
}

TEST(MerlGrid, FindsTheBinThatTheDatabaseDescribes) {
  std::mt19937 random(5);
  for (int i = 0; i < 10000; ++i) {
    const Direction<double> wi = any_direction(random);
    const Direction<double> wo = any_direction(random);
    ASSERT_EQ(table::merl_place({}, wi, wo).bin, described_bin(wi, wo));
    ASSERT_EQ(table::merl_place({}, wo, wi).bin, described_bin(wi, wo));
  }
}

TEST(MerlGrid, FindsEveryBinAtItsNodeAlsoInSinglePrecision) {
  const MerlGrid grid;
  const auto rounded = [](const Direction<double>& d) {
    const auto single = [](double x) { return static_cast<double>(static_cast<float>(x)); };
    return Direction<double>{single(d.x), single(d.y), single(d.z)};
  };
  for (std::size_t bin = 0; bin < grid.bins(); bin += 7) {
    const std::size_t row = bin / 180;
    const DirectionPair<double> at = table::directions_from({.theta_h = grid.theta_h(row / 90),
                                                             .theta_d = grid.theta_d(row % 90),
                                                             .phi_d = grid.phi_d(bin % 180)});
    const auto place = table::merl_place(grid, at.wi, at.wo);
    const auto single = table::merl_place(grid, rounded(at.wi), rounded(at.wo));
    const std::size_t expected = row % 90 == 0 ? row * 180 : bin;  // there phi_d is open
    ASSERT_EQ(place.bin, expected);
    ASSERT_EQ(single.bin, expected);
    ASSERT_TRUE(place.is_on_node && single.is_on_node && !place.is_turned && !single.is_turned);
    ASSERT_LT(place.moved, 1e-12);
  }
}

}  // namespace
}  // namespace gonio::tests
