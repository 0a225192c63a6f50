// The closed form between Phong's exponents and the other lobes, and the conventions of amplitudes.
#include "material/phong_conversion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "brdf/albedo.h"
#include "brdf/model.h"

namespace gonio::material {
namespace {

using std::numbers::pi;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// f_r of the lobe, without a diffuse part, in channel 0.
double f_r(const Lobe& lobe, const brdf::Direction<double>& wi, const brdf::Direction<double>& wo) {
  const brdf::Model model("lambert+" + lobe.term);
  return model.evaluate(std::array{0.0, lobe.amplitudes.front()}, std::array{lobe.shape}, wi, wo);
}

TEST(PhongConversion, IsWalters) {
  // a = sqrt(2/(n + 2)), Walter et al. 2007; for Phong's mirror lobe with 4 n.
  EXPECT_DOUBLE_EQ(closed_form({"blinn-phong", 50, {}}, "ward").shape, std::sqrt(2 / 52.0));
  EXPECT_DOUBLE_EQ(closed_form({"phong", 50, {}}, "ward").shape, std::sqrt(2 / 202.0));
  EXPECT_DOUBLE_EQ(closed_form({"ward-gmd", 0.1, {}}, "blinn-phong").shape, 198);
  EXPECT_DOUBLE_EQ(closed_form({"phong", 50, {}}, "blinn-phong").shape, 200);
  EXPECT_DOUBLE_EQ(closed_form({"blinn-phong", 0, {}}, "ward").shape, 1);
}

/// There and back: the exponent passes sqrt and 2/a^2 - 2, whose subtraction makes of the rounding
/// of n + 2 a relative error of at most (n + 2)/n times some epsilon: 6e-16 * 3 at n = 1.
TEST(PhongConversion, ThereAndBackIsExactToRoundingFrom1To10000) {
  const double epsilon = std::numeric_limits<double>::epsilon();
  for (const std::string_view from : convertible_terms()) {
    if (from.starts_with("ward")) continue;
    for (const std::string_view to : convertible_terms()) {
      for (double n = 1; n <= 10000; n *= 1.01) {
        const Lobe there = closed_form({std::string(from), n, {1e-3}}, to);
        const Lobe back = closed_form(there, from);
        ASSERT_NEAR(back.shape, n, 4 * epsilon * (n + 2)) << from << " " << to;
        ASSERT_NEAR(back.amplitudes[0], 1e-3, 8 * epsilon * 1e-3 * (n + 2) / n);
      }
    }
  }
}

TEST(PhongConversion, KeepsThePeakAtNormalIncidence) {
  const brdf::Direction<double> normal{0, 0, 1};
  for (const std::string_view from : convertible_terms()) {
    const Lobe lobe{std::string(from), from.starts_with("ward") ? 0.2 : 48.0, {0.01}};
    EXPECT_NEAR(peak_at_normal(from, lobe.shape) * 0.01, f_r(lobe, normal, normal), 1e-14) << from;
    for (const std::string_view to : convertible_terms()) {
      const Lobe converted = closed_form(lobe, to);
      EXPECT_NEAR(f_r(converted, normal, normal), f_r(lobe, normal, normal),
                  1e-13 * f_r(lobe, normal, normal))
          << from << " to " << to;
    }
  }
}

TEST(PhongConversion, KeepsTheCurvatureOfASharpPeak) {
  // (1 - f/peak) / delta^2 of the half vector at normal incidence, where delta^2 = 1e-6 makes the
  // next order of all these lobes a relative 1e-6 n: 1e-3.
  const brdf::Direction<double> wi{0, 0, 1};
  const auto wo = brdf::direction_from_radians(2e-3, 0.3);
  for (const std::string_view to : convertible_terms()) {
    const Lobe lobe = closed_form({"blinn-phong", 1000, {1e-3}}, to);
    const double fall = 1 - f_r(lobe, wi, wo) / f_r(lobe, wi, wi);
    EXPECT_NEAR(fall, 1 - std::exp(-500 * 1e-6), 0.01 * 500e-6) << to;
  }
}

TEST(PhongConversion, KnowsTheConventionsOfAmplitudes) {
  EXPECT_DOUBLE_EQ(raw_amplitude(Amplitude::raw, 0.3, 50), 0.3);
  EXPECT_DOUBLE_EQ(raw_amplitude(Amplitude::classic, 0.3, 50), 0.3 / pi);
  for (const double n : {1.0, 20.0, 500.0}) {
    for (const auto convention : {Amplitude::raw, Amplitude::normalised, Amplitude::classic}) {
      EXPECT_DOUBLE_EQ(amplitude_in(convention, raw_amplitude(convention, 0.7, n), n), 0.7);
      EXPECT_EQ(amplitude_from_name(name(convention)), convention);
    }
    // Lafortune and Willems' normalisation makes the albedo of Phong's lobe 1 at normal incidence.
    const auto albedo = brdf::basis_albedo(brdf::Model("phong"), std::array{n}, 0, 0);
    EXPECT_NEAR(raw_amplitude(Amplitude::normalised, 1, n) * albedo.values[1], 1, 1e-6);
  }
  EXPECT_THAT([] { amplitude_from_name("raws"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("raw, normalised and classic")));
}

TEST(PhongConversion, RefusesWhatHasNoClosedForm) {
  EXPECT_THAT(
      [] {
        closed_form({"ward", 2, {1}}, "blinn-phong");
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("roughness above 1")));
  EXPECT_THAT(
      [] {
        closed_form({"ward", 1e-4, {1}}, "blinn-phong");
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("exponent = 2e+08")));
  EXPECT_THAT(
      [] {
        closed_form({"phong", 20, {5}}, "ashikhmin-shirley");
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("Rs = 1.551")));
  EXPECT_THAT(
      [] {
        closed_form({"phong", 20, {1}}, "ward-aniso");
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("ashikhmin-shirley")));
  EXPECT_NO_THROW(closed_form({"ward", 1, {1}}, "blinn-phong"));
}

}  // namespace
}  // namespace gonio::material
