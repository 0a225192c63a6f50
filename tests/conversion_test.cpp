// Conversions between models: the best fit against the closed form, and what is kept.
#include "material/conversion.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "brdf/lobe_directions.h"
#include "material/evaluate.h"
#include "material/material_json.h"

namespace gonio::material {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

LobeMaterial lobe_of(std::string_view term, double shape, double amplitude) {
  return {.name = "lobe",
          .channels = {"Y"},
          .rho_d = {0},
          .lobe = {std::string(term), shape, {amplitude}}};
}

double value_of(const Material& material, std::string_view name, std::size_t channel = 0) {
  for (const ParameterValue& p : material.parameters) {
    if (p.name == name) return p.value.at(channel);
  }
  ADD_FAILURE() << "no " << name;
  return 0;
}

using Pair = std::tuple<const char*, const char*, bool>;

class BestFit : public testing::TestWithParam<Pair> {};

TEST_P(BestFit, IsNeverWorseThanTheClosedFormInItsOwnMetric) {
  const auto [from, to, is_classic] = GetParam();
  for (const double exponent : {1.0, 3.0, 10.0, 50.0, 300.0, 10000.0}) {
    // As bright as Ashikhmin and Shirley's lobe can be at its least reflectance.
    LobeMaterial material = lobe_of(from, exponent, 0.02 * (4 * exponent + 1) / (8 * 3.15));
    material.is_classic = is_classic;
    for (const auto metric : {fit::Metric::cosine_l2, fit::Metric::l2, fit::Metric::log,
                              fit::Metric::cube_root, fit::Metric::relative}) {
      ConversionOptions options{.method = ConversionMethod::closed_form, .metric = metric};
      const double closed = convert(material, to, options).metric_error;
      options.method = ConversionMethod::best_fit;
      const double best = convert(material, to, options).metric_error;
      EXPECT_LE(best, closed * (1 + 1e-9))
          << exponent << " " << fit::name(metric) << ": " << best << " > " << closed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, BestFit,
                         testing::Values(Pair{"phong", "ward", false}, Pair{"phong", "ward", true},
                                         Pair{"blinn-phong", "ward", true},
                                         Pair{"blinn-phong", "ward-gmd", false},
                                         Pair{"phong", "ashikhmin-shirley", false},
                                         Pair{"blinn-phong", "ashikhmin-shirley", true},
                                         Pair{"phong", "blinn-phong", false}),
                         [](const testing::TestParamInfo<Pair>& test) {
                           return fmt::format("Case{}", test.index);
                         });

TEST(Conversion, OfALobeToItselfIsExact) {
  for (const auto method : {ConversionMethod::closed_form, ConversionMethod::best_fit}) {
    const auto c = convert(lobe_of("ward", 0.2, 0.3), "ward", {.method = method});
    EXPECT_NEAR(value_of(c.material, "alpha"), 0.2, 1e-8);
    EXPECT_NEAR(value_of(c.material, "rho_s"), 0.3, 1e-8);
    EXPECT_LT(c.remaining.peak, 1e-7);
  }
}

TEST(Conversion, OfASharpClassicHighlightToWardAlmostVanishes) {
  // Ward's sqrt(cos_i cos_o) is what a highlight without the cosine has at the mirror direction:
  // for exponent 10000 the lobe is a quarter of a degree wide and sees little else.
  LobeMaterial classic = lobe_of("blinn-phong", 10000, 1);
  classic.is_classic = true;
  EXPECT_LT(convert(classic, "ward", {}).remaining.rms, 0.01);
  // A physical Blinn-Phong lobe keeps f_r where Ward's grows as 1/cos: a quarter apart up to 75
  // deg.
  EXPECT_GT(convert(lobe_of("blinn-phong", 10000, 1), "ward", {}).remaining.rms, 0.2);
}

TEST(Conversion, ReportsTheDifferenceThatASecondLookFinds) {
  const LobeMaterial from = lobe_of("blinn-phong", 30, 1);
  const ConversionOptions options{.incidence = Incidence{.theta_deg = {40}}};
  const Conversion c = convert(from, "ward", options);
  const brdf::Model blinn("blinn-phong");
  const brdf::BoundModel ward = bind(c.material);
  const auto wi = brdf::direction_from_degrees(40, 0);
  double worst = 0;
  double brightest = 0;
  // Every degree of the hemisphere: the comparison's directions are others.
  for (int theta = 0; theta <= 80; ++theta) {
    for (int phi = 0; phi < 360; ++phi) {
      const auto wo = brdf::direction_from_degrees(theta, phi);
      const double value = blinn.evaluate(std::array{0.0, 1.0}, std::array{30.0}, wi, wo);
      std::array<double, 1> stand_in{};
      ward.f_r(wi, wo, stand_in);
      worst = std::max(worst, std::abs(stand_in[0] - value));
      brightest = std::max(brightest, value);
    }
  }
  // Neither grid meets the extremes to better than 2 %: a degree apart, and 15 deg of azimuth.
  EXPECT_NEAR(c.remaining.peak, worst / brightest, 0.02 * worst / brightest);
  EXPECT_NEAR(c.remaining.where.theta_i_deg, 40, 1e-9);
}

TEST(Conversion, KeepsTheDiffusePartAndTheChannels) {
  const LobeMaterial from{.name = "paint",
                          .channels = {"R", "G", "B"},
                          .rho_d = {0.1, 0.2, 0.3},
                          .lobe = {"phong", 60, {0.5, 0.4, 0.1}}};
  const Conversion c = convert(from, "ward", {});
  EXPECT_EQ(c.material.name, "paint");
  EXPECT_EQ(c.material.channels, from.channels);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(value_of(c.material, "rho_d", k), from.rho_d[k]);
  // One shape for all channels: the amplitudes keep their ratios.
  EXPECT_NEAR(value_of(c.material, "rho_s", 0) / value_of(c.material, "rho_s", 2), 5, 1e-9);
}

Material ward_aniso() {
  return parse_material(R"({"format": "gonio-material", "version": 1, "name": "brass",
    "model": "oren-nayar+ward-aniso", "channels": ["Y"], "parameters": {"rho_d": {"value": 0.3},
    "sigma": {"value": 0.4}, "rho_s": {"value": 0.2}, "alpha_x": {"value": 0.05},
    "alpha_y": {"value": 0.16}}})",
                        "brass.json");
}

TEST(Conversion, OfAnyMaterialIsABestFit) {
  const Material from = ward_aniso();
  const Conversion c = convert(from, brdf::Model("oren-nayar+blinn-phong"), {});
  EXPECT_EQ(c.material.model, "oren-nayar+blinn-phong");
  EXPECT_EQ(value_of(c.material, "rho_d"), 0.3);
  EXPECT_EQ(value_of(c.material, "sigma"), 0.4);
  // Between the exponents of alpha_y and alpha_x: 2/a^2 - 2.
  EXPECT_GT(value_of(c.material, "exponent"), 76);
  EXPECT_LT(value_of(c.material, "exponent"), 798);
  ASSERT_TRUE(c.material.conversion);
  EXPECT_EQ(c.material.conversion->from, "oren-nayar+ward-aniso");
  EXPECT_EQ(c.material.conversion->rms, c.remaining.rms);
  EXPECT_GT(c.remaining.rms, 0.1);
  EXPECT_THAT(
      [&] { convert(from, brdf::Model("blinn-phong"), {.method = ConversionMethod::closed_form}); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("no closed form")));
  EXPECT_THAT([&] { convert(from, brdf::Model("blinn-phong"), {.metric = fit::Metric::chi2}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("noise of a measurement")));
}

TEST(Conversion, IsReadBackToTheSameBits) {
  const Material material = convert(lobe_of("phong", 17, 0.3), "ward", {}).material;
  const auto json = to_json(material);
  const Material again = parse_material(json.dump(), "again.json");
  EXPECT_EQ(to_json(again), json);
  EXPECT_EQ(again.conversion->rms, material.conversion->rms);
  EXPECT_EQ(value_of(again, "alpha"), value_of(material, "alpha"));
}

}  // namespace
}  // namespace gonio::material
