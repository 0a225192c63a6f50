// How far two materials are apart: each figure against what it is by definition.
#include "material/comparison.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace gonio::material {
namespace {

using brdf::Direction;

const std::vector<std::string> two_channels{"A", "B"};

Reflectance constant(double a, double b) {
  return [=](const Direction<double>&, const Direction<double>&, std::span<double> values) {
    values[0] = a;
    values[1] = b;
  };
}

TEST(Comparison, IsZeroForTheSameReflectance) {
  const auto samples = sample(constant(0.2, 3), two_channels, {});
  const Difference d = difference(samples, constant(0.2, 3));
  EXPECT_EQ(d.peak, 0);
  EXPECT_EQ(d.rms, 0);
  EXPECT_EQ(d.albedo, 0);
}

TEST(Comparison, OfConstantsIsTheirRatio) {
  const auto samples = sample(constant(0.2, 0.1), two_channels, {});
  // A is right; B is 0.12 for 0.1.
  const Difference d = difference(samples, constant(0.2, 0.12));
  EXPECT_NEAR(d.peak, 0.1, 1e-12);  // of the brightest channel's 0.2
  EXPECT_EQ(d.where.channel, "B");
  EXPECT_NEAR(d.where.theta_i_deg, 0, 1e-6);  // f_r cos_i is largest there
  EXPECT_NEAR(d.rms, 0.02 / std::hypot(0.2, 0.1), 1e-12);
  // Of Lambert's reflector: pi times f_r, to the 2e-3 of the sums.
  EXPECT_NEAR(d.albedo, 0.02 * std::numbers::pi, 2e-3 * 0.02 * std::numbers::pi);
}

TEST(Comparison, ToldFromWhichLightAndChannelItIs) {
  const auto samples = sample(constant(1, 1), two_channels, {});
  const Reflectance wrong_at_45 = [](const Direction<double>& wi, const Direction<double>&,
                                     std::span<double> values) {
    values[0] = 1;
    values[1] = std::abs(wi.z - std::numbers::sqrt2 / 2) < 1e-6 ? 0.5 : 1;
  };
  const Difference d = difference(samples, wrong_at_45);
  EXPECT_NEAR(d.where.theta_i_deg, 45, 1e-9);
  EXPECT_EQ(d.where.channel, "B");
  EXPECT_NEAR(d.peak, 0.5 * std::numbers::sqrt2 / 2, 1e-12);
  EXPECT_LT(d.albedo, 0);
}

TEST(Comparison, LooksAtViewersUpTo80DegreesOnly) {
  const auto samples = sample(constant(1, 1), two_channels, {});
  const double cos_81 = std::cos(81 * std::numbers::pi / 180);
  const Reflectance wrong_at_grazing = [=](const Direction<double>&, const Direction<double>& wo,
                                           std::span<double> values) {
    values[0] = values[1] = wo.z < cos_81 ? 7 : 1;
  };
  const Difference d = difference(samples, wrong_at_grazing);
  EXPECT_EQ(d.peak, 0);
  EXPECT_EQ(d.rms, 0);
  EXPECT_GT(d.albedo, 0);
}

TEST(Comparison, WithNothingToCompareWithIsZeroOrInfinite) {
  const auto black = sample(constant(0, 0), two_channels, {});
  EXPECT_EQ(difference(black, constant(0, 0)).peak, 0);
  EXPECT_EQ(difference(black, constant(0, 0)).rms, 0);
  EXPECT_EQ(difference(black, constant(0, 1)).rms, std::numeric_limits<double>::infinity());
  EXPECT_EQ(difference(black, constant(0, 1)).peak, std::numeric_limits<double>::infinity());
}

TEST(Comparison, SeesATangentFromSeveralAzimuths) {
  EXPECT_EQ(default_incidence(brdf::Model("ward")).phi_deg.size(), 1U);
  EXPECT_GT(default_incidence(brdf::Model("ward-aniso")).phi_deg.size(), 1U);
}

TEST(Comparison, IsTheSameFromOneAzimuthAndFromSeveralWhereThereIsNoTangent) {
  const Reflectance lobe = [](const Direction<double>& wi, const Direction<double>& wo,
                              std::span<double> values) {
    values[0] = std::exp(-30 * (std::pow(wi.x + wo.x, 2) + std::pow(wi.y + wo.y, 2)));
    values[1] = wi.z * wo.z;
  };
  const Difference one = difference(sample(lobe, two_channels, {}), constant(0.2, 0.1));
  const Difference several = difference(
      sample(lobe, two_channels, default_incidence(brdf::Model("ward-aniso"))), constant(0.2, 0.1));
  EXPECT_NEAR(one.peak, several.peak, 1e-9);
  EXPECT_NEAR(one.rms, several.rms, 1e-9);
  EXPECT_NEAR(one.albedo, several.albedo, 1e-9);
  // A light that is given twice counts twice, and its albedo is no other.
  const Difference twice =
      difference(sample(lobe, two_channels, {.theta_deg = {30, 30}}), constant(0.2, 0.1));
  const Difference once =
      difference(sample(lobe, two_channels, {.theta_deg = {30}}), constant(0.2, 0.1));
  EXPECT_NEAR(twice.albedo, once.albedo, 1e-12);
  EXPECT_NEAR(twice.rms, once.rms, 1e-12);
}

TEST(Comparison, RefusesALightBeyond80Degrees) {
  EXPECT_NO_THROW(sample(constant(1, 1), two_channels, {.theta_deg = {80}}));
  EXPECT_THROW(sample(constant(1, 1), two_channels, {.theta_deg = {85}}), std::invalid_argument);
  EXPECT_THROW(sample(constant(1, 1), two_channels, {.theta_deg = {-1}}), std::invalid_argument);
}

}  // namespace
}  // namespace gonio::material
