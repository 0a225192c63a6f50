// Radiance: the lobe against its formula in angles, exactness where Radiance holds the model, and
// the file's numbers, read back, against the material.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "export/account.h"
#include "export/radiance.h"
#include "export/radiance_lobe.h"
#include "export/rgb.h"
#include "table/file_error.h"
#include "tests/exported_material.h"

namespace gonio::exports {
namespace {

using brdf::Direction;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using tests::Rgb;
using tests::rgb_material_of;

/// The primitive of a scene fragment as Radiance reads it: words, comments left out.
struct Primitive {
  std::string modifier, type, identifier;
  std::vector<std::string> strings;
  std::vector<double> reals;
};

Primitive parsed(const std::string& text) {
  std::istringstream lines(text);
  std::string words;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with('#')) words += line + "\n";
  }
  std::istringstream stream(words);
  Primitive primitive;
  std::size_t count = 0;
  stream >> primitive.modifier >> primitive.type >> primitive.identifier >> count;
  primitive.strings.resize(count);
  for (std::string& word : primitive.strings) stream >> word;
  stream >> count;
  EXPECT_EQ(count, 0);  // integers, of which no primitive has any
  stream >> count;
  primitive.reals.resize(count);
  for (double& real : primitive.reals) stream >> real;
  EXPECT_FALSE(stream.fail()) << text;
  stream >> std::ws;
  EXPECT_TRUE(stream.eof()) << text;
  return primitive;
}

/// What the reference manual and normal.c, aniso.c say of a primitive, in angles: delta of the half
/// vector from the normal, phi of it from u.
Rgb radiance_f_r(const Primitive& primitive, const Direction<double>& wi,
                 const Direction<double>& wo) {
  const double hx = wi.x + wo.x;
  const double hy = wi.y + wo.y;
  const double hz = wi.z + wo.z;
  const double length = std::sqrt(hx * hx + hy * hy + hz * hz);
  const double delta = std::acos(std::min(1.0, hz / length));
  const double u_angle = primitive.strings.empty() ? 0
                                                   : std::atan2(std::stod(primitive.strings[1]),
                                                                std::stod(primitive.strings[0]));
  const double phi = std::atan2(hy, hx) - u_angle;
  const double u = primitive.reals[4];
  const double v = primitive.reals.back();
  const double exponent = std::pow(std::tan(delta), 2) *
                          (std::pow(std::cos(phi) / u, 2) + std::pow(std::sin(phi) / v, 2));
  const double lobe =
      std::exp(-exponent) * length * length / (std::numbers::pi * u * v * std::pow(hz, 4));
  const double spec = primitive.reals[3];
  const bool metal = primitive.type.starts_with("metal");
  Rgb f_r{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double color = primitive.reals[c];
    f_r[c] = color * (1 - spec) / std::numbers::pi + (metal ? color : 1) * spec * lobe;
  }
  return f_r;
}

Primitive primitive_of(const Exported& exported) { return parsed(exported.files.at(0).text); }

double plain_loss_of(const Primitive& primitive, const material::Material& material) {
  return tests::plain_rms_loss(
      material, [&](const auto& wi, const auto& wo) { return radiance_f_r(primitive, wi, wo); },
      primitive.reals.size() == 6);
}

TEST(RadianceLobe, IsTheFormulaOfRadiance) {
  const Primitive plastic{"void", "plastic", "m", {}, {0.5, 0.3, 0.2, 0.07, 0.15}};
  const Primitive metal2{
      "void", "metal2", "m", {"1", "0", "0", "."}, {0.9, 0.6, 0.3, 0.8, 0.1, 0.3}};
  for (const double theta_i : {0.0, 30.0, 70.0}) {
    for (const double theta_o : {1.0, 35.0, 80.0}) {
      for (const double phi_o : {0.0, 100.0, 175.0}) {
        const auto wi = brdf::direction_from_degrees(theta_i, 20);
        const auto wo = brdf::direction_from_degrees(theta_o, phi_o);
        const Rgb ours = RadiancePlastic::f_r<double>({0.5, 0.3, 0.2, 0.07, 0.15}, wi, wo);
        const Rgb ours2 = RadianceMetal2::f_r<double>({0.9, 0.6, 0.3, 0.8, 0.1, 0.3}, wi, wo);
        for (std::size_t c = 0; c < 3; ++c) {
          // acos loses half the digits near the normal.
          const double truth = radiance_f_r(plastic, wi, wo)[c];
          EXPECT_NEAR(ours[c], truth, 1e-6 * truth);
          const double truth2 = radiance_f_r(metal2, wi, wo)[c];
          EXPECT_NEAR(ours2[c], truth2, 1e-6 * truth2);
        }
      }
    }
  }
}

TEST(ExportRadiance, OfGreyHighlightsInTheBoundedWardModelIsExactlyPlastic) {
  const auto material = rgb_material_of(
      "ward-gmd", {{"rho_d", {0.4, 0.2, 0.1}}, {"rho_s", {0.05, 0.05, 0.05}}, {"alpha", {0.12}}});
  const Exported exported = to_radiance(material);
  const Primitive primitive = primitive_of(exported);
  EXPECT_EQ(primitive.type, "plastic");
  EXPECT_EQ(primitive.identifier, "test_paint");
  // rho_d = color (1 - spec), rho_s = spec, to the 12 digits of the file.
  ASSERT_EQ(primitive.reals.size(), 5);
  EXPECT_NEAR(primitive.reals[0], 0.4 / 0.95, 1e-11);
  EXPECT_NEAR(primitive.reals[1], 0.2 / 0.95, 1e-11);
  EXPECT_NEAR(primitive.reals[2], 0.1 / 0.95, 1e-11);
  EXPECT_NEAR(primitive.reals[3], 0.05, 1e-11);
  EXPECT_NEAR(primitive.reals[4], 0.12, 1e-11);
  EXPECT_LT(exported.loss.peak, exact_difference);
  EXPECT_THAT(exported.fitted_as, StartsWith("exact: Radiance plastic"));
  EXPECT_LT(plain_loss_of(primitive, material), 1e-7);  // the angles of the plain formula
}

TEST(ExportRadiance, OfProportionalColoursIsExactlyMetal) {
  const auto material = rgb_material_of(
      "ward-gmd", {{"rho_d", {0.18, 0.12, 0.06}}, {"rho_s", {0.72, 0.48, 0.24}}, {"alpha", {0.2}}});
  const Exported exported = to_radiance(material);
  const Primitive primitive = primitive_of(exported);
  EXPECT_EQ(primitive.type, "metal");
  // color = rho_d + rho_s, spec = rho_s / color.
  EXPECT_NEAR(primitive.reals[0], 0.9, 1e-11);
  EXPECT_NEAR(primitive.reals[1], 0.6, 1e-11);
  EXPECT_NEAR(primitive.reals[2], 0.3, 1e-11);
  EXPECT_NEAR(primitive.reals[3], 0.8, 1e-11);
  EXPECT_THAT(exported.fitted_as, StartsWith("exact: Radiance metal"));
}

TEST(ExportRadiance, TurnsTheVectorUWithTheTangent) {
  const double psi = 0.4;
  const auto material = rgb_material_of("ward-gmd-aniso", {{"rho_d", {0.4, 0.2, 0.1}},
                                                           {"rho_s", {0.05, 0.05, 0.05}},
                                                           {"alpha_x", {0.1}},
                                                           {"alpha_y", {0.3}},
                                                           {"psi", {psi}}});
  const Exported exported = to_radiance(material);
  const Primitive primitive = primitive_of(exported);
  EXPECT_EQ(primitive.type, "plastic2");
  ASSERT_EQ(primitive.strings.size(), 4);
  EXPECT_NEAR(std::stod(primitive.strings[0]), std::cos(psi), 1e-11);
  EXPECT_NEAR(std::stod(primitive.strings[1]), std::sin(psi), 1e-11);
  EXPECT_EQ(primitive.strings[2], "0");
  EXPECT_EQ(primitive.strings[3], ".");
  EXPECT_NEAR(primitive.reals[4], 0.1, 1e-11);
  EXPECT_NEAR(primitive.reals[5], 0.3, 1e-11);
  EXPECT_THAT(exported.fitted_as, StartsWith("exact:"));
  EXPECT_LT(plain_loss_of(primitive, material), 1e-7);
}

TEST(ExportRadiance, StatesTheLossOfAModelThatItDoesNotHold) {
  const auto material = rgb_material_of(
      "ward", {{"rho_d", {0.3, 0.2, 0.1}}, {"rho_s", {0.2, 0.2, 0.2}}, {"alpha", {0.2}}});
  const Exported exported = to_radiance(material);
  const std::string& text = exported.files.at(0).text;
  EXPECT_THAT(exported.fitted_as, Not(HasSubstr("exact")));
  EXPECT_GT(exported.loss.rms, 0.01);
  EXPECT_THAT(text, HasSubstr("# loss of reflected radiance: " + loss_text(exported.loss) + "\n"));
  EXPECT_THAT(text,
              HasSubstr("# model: lambert+ward; channels R, G, B; rho_d = (0.3, 0.2, 0.1); rho_s"));
  // The sums over the fit's directions are good to about 1 % of the loss.
  EXPECT_NEAR(plain_loss_of(primitive_of(exported), material), exported.loss.rms,
              0.02 * exported.loss.rms);
}

TEST(ExportRadiance, WarnsOfWhatRadiancesManualDoes) {
  const Exported exported = to_radiance(rgb_material_of(
      "ward-gmd", {{"rho_d", {0.9, 0.2, 0.1}}, {"rho_s", {0.2, 0.2, 0.2}}, {"alpha", {0.3}}}));
  EXPECT_THAT(exported.warnings, Contains(HasSubstr("specularity of 0.2 is above 0.1")));
  EXPECT_THAT(exported.warnings, Contains(HasSubstr("roughness of 0.3 is above 0.2")));
  EXPECT_THAT(exported.warnings, Contains(HasSubstr("reflects more than it receives")));
  for (const std::string& warning : exported.warnings) {
    EXPECT_THAT(exported.files[0].text, HasSubstr("# warning: " + warning + "\n"));
  }
}

// normal.c takes a squared roughness of 1e-6 and less for a mirror, aniso.c does not.
TEST(ExportRadiance, TakesPlastic2ForALobeTooNarrowForPlastic) {
  const Exported exported = to_radiance(rgb_material_of(
      "ward-gmd", {{"rho_d", {0.2, 0.2, 0.1}}, {"rho_s", {0.05, 0.05, 0.05}}, {"alpha", {5e-4}}}));
  const Primitive primitive = primitive_of(exported);
  EXPECT_EQ(primitive.type, "plastic2");
  EXPECT_NEAR(primitive.reals[4], 5e-4, 1e-14);
  EXPECT_NEAR(primitive.reals[5], 5e-4, 1e-14);
  EXPECT_THAT(exported.fitted_as, StartsWith("exact:"));
  EXPECT_THAT(exported.warnings, IsEmpty());
}

// Most of what this lacquer reflects, Fresnel's factor adds towards grazing; Ward's lobe has none.
TEST(ExportRadiance, SaysWhenNothingIsAlike) {
  const Exported exported = to_radiance(rgb_material_of(
      "ashikhmin-shirley", {{"Rd", {0.3, 0.3, 0.3}}, {"Rs", {0.05, 0.05, 0.05}}, {"n", {200}}}));
  EXPECT_GT(exported.loss.rms, 0.5);
  EXPECT_THAT(exported.warnings, Contains(HasSubstr("nothing like this model")));
  EXPECT_THAT(exported.files[0].text, HasSubstr("# warning: the target has nothing like"));
}

TEST(ExportRadiance, KeepsAnyNameOnItsCommentLine) {
  auto material = rgb_material_of(
      "ward-gmd", {{"rho_d", {0.2, 0.2, 0.1}}, {"rho_s", {0.05, 0.05, 0.05}}, {"alpha", {0.1}}});
  material.name = "2 coats\nvoid light l";
  const Exported exported = to_radiance(material);
  EXPECT_EQ(primitive_of(exported).identifier, "_2_coats_void_light_l");
  EXPECT_THAT(exported.files[0].text, HasSubstr("# material: 2 coats void light l\n"));
}

material::Material with_channels(const std::vector<std::string>& channels) {
  auto material = rgb_material_of("ward-gmd", {{"rho_d", {}}, {"rho_s", {}}, {"alpha", {0.1}}});
  material.channels = channels;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    material.parameters[0].value.push_back(0.1 * double(c + 1));
    material.parameters[1].value.push_back(0.05);
  }
  return material;
}

TEST(RgbChannels, AreFoundByNameOrByWavelength) {
  using Order = std::array<std::size_t, 3>;
  EXPECT_EQ(rgb_channels(with_channels({"R", "G", "B"})).channel, (Order{0, 1, 2}));
  EXPECT_EQ(rgb_channels(with_channels({"b", "r", "g"})).channel, (Order{1, 2, 0}));
  const RgbChannels waves = rgb_channels(with_channels({"525nm", "630nm", "465.5 nm"}));
  EXPECT_EQ(waves.channel, (Order{1, 0, 2}));
  EXPECT_EQ(waves.statement, "R is the channel '630nm', G '525nm', B '465.5 nm', by wavelength");
  EXPECT_EQ(rgb_channels(with_channels({"L"})).channel, (Order{0, 0, 0}));
}

TEST(RgbChannels, OfOtherChannelsAreRefusedInOneLine) {
  const std::vector<std::vector<std::string>> others{{"R", "G"},
                                                     {"X", "Y", "Z"},
                                                     {"R", "525nm", "465nm"},
                                                     {"525nm", "525 nm", "465nm"},
                                                     {"R", "G", "B", "IR"}};
  for (const auto& channels : others) {
    try {
      rgb_channels(with_channels(channels));
      ADD_FAILURE() << channels.front() << " ... passed";
    } catch (const table::FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr("material 'test paint': channels: found " +
                                          std::to_string(channels.size())));
      EXPECT_THAT(error.what(), HasSubstr("expected R, G and B"));
      EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
    }
  }
}

TEST(ExportRadiance, PutsTheChannelsWhereTheyBelong) {
  const Exported exported = to_radiance(with_channels({"465nm", "525nm", "630nm"}));
  const Primitive primitive = primitive_of(exported);
  EXPECT_NEAR(primitive.reals[0], 0.3 / 0.95, 1e-11);
  EXPECT_NEAR(primitive.reals[1], 0.2 / 0.95, 1e-11);
  EXPECT_NEAR(primitive.reals[2], 0.1 / 0.95, 1e-11);
  EXPECT_THAT(exported.files[0].text, HasSubstr("# channels: R is the channel '630nm'"));
  const Primitive grey = primitive_of(to_radiance(with_channels({"L"})));
  EXPECT_EQ(grey.reals[0], grey.reals[1]);
  EXPECT_EQ(grey.reals[0], grey.reals[2]);
}

}  // namespace
}  // namespace gonio::exports
