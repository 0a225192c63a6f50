// The parameters' uncertainty carried through the model, against derivatives in closed form: of
// f_r = rho_d / pi + L, L = rho_s exp(-q) / (4 pi alpha^2 cos), q = tan^2 / alpha^2.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "tests/trade_material.h"
#include "trade/parameter_uncertainty.h"

namespace gonio::trade {
namespace {

using std::numbers::pi;

constexpr double rho_d = 0.4;
constexpr double rho_s = 0.1;
constexpr double alpha = 0.15;

/// With these standard deviations, and the correlation of rho_s and alpha.
material::Material fitted(std::optional<double> rho_d_stddev, std::optional<double> rho_s_stddev,
                          std::optional<double> alpha_stddev, double correlation = 0) {
  material::Material material = tests::ward_material(rho_d, rho_s, alpha);
  material.parameters[0].stddev = {rho_d_stddev};
  material.parameters[1].stddev = {rho_s_stddev};
  material.parameters[2].stddev = {alpha_stddev};
  material.fit.emplace();
  material.fit->correlation_parameters = {"rho_d.Y", "rho_s.Y", "alpha"};
  material.fit->correlation = {{1., 0., 0.}, {0., 1., correlation}, {0., correlation, 1.}};
  return material;
}

/// The viewer at the normal, the light 20 degrees off: the half vector is at 10 degrees.
const brdf::DirectionPair<double> flank{brdf::direction_from_degrees(20, 30),
                                        brdf::direction_from_degrees(0, 0)};
const double q = std::pow(std::tan(10 * pi / 180) / alpha, 2);
const double lobe =
    rho_s * std::exp(-q) / (4 * pi * alpha * alpha * std::sqrt(std::cos(20 * pi / 180)));
const double by_alpha = lobe * (2 * q - 2) / alpha;

double stddev_of(const material::Material& material) {
  return parameter_uncertainty(material, std::vector{flank}).value().at(0);
}

TEST(ParameterUncertainty, IsTheClosedFormForEachParameterAlone) {
  EXPECT_NEAR(stddev_of(fitted(0.01, {}, {})), 0.01 / pi, 1e-9);
  EXPECT_NEAR(stddev_of(fitted({}, 0.002, {})), lobe / rho_s * 0.002, 1e-9 * lobe);
  // Central differences of a step of 1e-2 standard deviations: truncated at 1e-8.
  EXPECT_NEAR(stddev_of(fitted({}, {}, 0.001)), std::abs(by_alpha) * 0.001, 1e-7 * lobe);
}

TEST(ParameterUncertainty, CombinesThemByTheirCorrelation) {
  const double a = lobe / rho_s * 0.002;
  const double b = by_alpha * 0.003;
  for (const double r : {-1., -0.7, 0., 0.7, 1.}) {
    SCOPED_TRACE(r);
    EXPECT_NEAR(stddev_of(fitted({}, 0.002, 0.003, r)), std::sqrt(a * a + b * b + 2 * r * a * b),
                1e-6 * std::hypot(a, b));
  }
}

TEST(ParameterUncertainty, OfATinyDeviationIsNotRounding) {
  EXPECT_NEAR(stddev_of(fitted({}, {}, 1e-14)), std::abs(by_alpha) * 1e-14,
              1e-6 * std::abs(by_alpha) * 1e-14);
}

TEST(ParameterUncertainty, AtABoundIsOneSided) {
  material::Material material = fitted({}, 0.01, {});
  material.parameters[1].value = {0};  // rho_s may not go below
  EXPECT_NEAR(stddev_of(material), lobe / rho_s * 0.01, 1e-9 * lobe);
}

TEST(ParameterUncertainty, TellsChannelsApart) {
  material::Material material = fitted({}, {}, {});
  material.channels = {"R", "G"};
  material.parameters[0] = {"rho_d", {0.1, 0.2}, {0.01, 0.03}, {}};
  material.parameters[1] = {"rho_s", {rho_s, rho_s}, {{}, {}}, {}};
  const auto stddev = parameter_uncertainty(material, std::vector{flank, flank}).value();
  ASSERT_EQ(stddev.size(), 4U);
  for (const std::size_t pair : {0U, 1U}) {
    EXPECT_NEAR(stddev[2 * pair], 0.01 / pi, 1e-9);
    EXPECT_NEAR(stddev[2 * pair + 1], 0.03 / pi, 1e-9);
  }
}

TEST(ParameterUncertainty, IsNoneWithoutAFitOrAnyDeviation) {
  EXPECT_FALSE(parameter_uncertainty(tests::ward_material(0.1, 0.1, 0.1), std::vector{flank}));
  EXPECT_FALSE(parameter_uncertainty(fitted({}, {}, {}), std::vector{flank}));
}

}  // namespace
}  // namespace gonio::trade
