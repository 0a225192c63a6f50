// Where the published Ward listings and their texture depart from the models, and by how much.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "brdf/lambert.h"
#include "brdf/listings.h"
#include "brdf/ward.h"
#include "tests/listing_draws.h"

namespace gonio::tests {
namespace {

namespace listings = brdf::listings;
using brdf::AnisotropicWard;
using brdf::Direction;
using brdf::IsotropicWard;
using brdf::Lambert;
using brdf::WardApproxLobe;
using brdf::WardLobe;
using listings::Float3;
using listings::Geometry;

constexpr double pi = std::numbers::pi;
constexpr Geometry facing{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};

/// The largest value that a Ward lobe of rho_s = 1 has at these two directions' cosines.
double ward_peak(double ax, double ay, const ListingDraw& draw) {
  return 1 / (4 * pi * ax * ay * std::sqrt(draw.wi.z * draw.wo.z));
}

TEST(ListingsTest, WritePiTooSmallBy8In10Million) {
  EXPECT_NEAR(1 - double{listings::shader_pi} / pi, 8.1e-7, 0.1e-7);
}

// The tolerance is float's: n.h, and with it tan^2, is off by up to 3e-7.
TEST(ListingsTest, WardIsotropicIsTheModelAtTheBiasedRoughnessWithADiffuseTermPiTimesTooBright) {
  ListingDraws draws;
  for (const float roughness : {0.05F, 0.1F, 0.3F, 1.0F}) {
    SCOPED_TRACE(roughness);
    const double alpha = std::sqrt(double{roughness} * roughness + 1e-5);
    const double tolerance = 1e-6 + 3e-7 / (alpha * alpha);
    for (int i = 0; i < 2000; ++i) {
      const ListingDraw draw = i % 2 == 0 ? draws.within_lobe(alpha, alpha) : draws.anywhere();
      const double diffuse = f_r<Lambert>({0.2}, {}, draw.wi, draw.wo);
      const double specular = f_r<IsotropicWard<WardLobe>>({0.4}, {alpha}, draw.wi, draw.wo);
      EXPECT_NEAR(listings::ward_isotropic(draw.at, {0.2F, 0.4F, roughness}),
                  draw.wi.z * (pi * diffuse + specular),
                  tolerance * draw.wi.z * (0.2 + 0.4 * ward_peak(alpha, alpha, draw)));
    }
  }
}

/// The roughness whose Ward lobe has this value at normal incidence and exitance.
double roughness_of_peak(double value) { return 1 / std::sqrt(4 * pi * value); }

TEST(ListingsTest, WardIsotropicTakesSmallRoughnessesForLargerOnes) {
  EXPECT_NEAR(roughness_of_peak(listings::ward_isotropic(facing, {0, 1, 0.01F})), 0.0105, 5e-5);
  EXPECT_NEAR(roughness_of_peak(listings::ward_isotropic(facing, {0, 1, 0.001F})), 0.0033, 5e-5);
}

/// The vectors of a draw turned so that the normal is this unit vector, in float.
Geometry turned(const ListingDraw& draw, const Direction<double>& n) {
  const double sine = std::hypot(n.x, n.y);
  const Direction<double> t{n.x * n.z / sine, n.y * n.z / sine, -sine};
  const Direction<double> b{-n.y / sine, n.x / sine, 0};
  const auto turn = [&](const Direction<double>& w) {
    return in_float({w.x * t.x + w.y * b.x + w.z * n.x, w.x * t.y + w.y * b.y + w.z * n.y,
                     w.x * t.z + w.y * b.z + w.z * n.z});
  };
  return {in_float(n), turn(draw.wi), turn(draw.wo)};
}

/// tan^2 of the angle between n and l + v, from the components.
double tangent_squared(const Geometry& at) {
  const Direction<double> n = in_double(at.n);
  const Direction<double> h = brdf::half_vector(in_double(at.l), in_double(at.v));
  const double along = n.x * h.x + n.y * h.y + n.z * h.z;
  const double x = n.y * h.z - n.z * h.y;
  const double y = n.z * h.x - n.x * h.z;
  const double z = n.x * h.y - n.y * h.x;
  return (x * x + y * y + z * z) / (along * along);
}

struct AngleStudy {
  double worst = 0;      // error of exp(-tan^2/alpha^2) as a fraction of its peak, where finite
  double nan_share = 0;  // of the half vectors within 3 alpha of the normal
};

enum class Normal { z, anywhere };

/// exp(-tan^2(acos(n.h)) / alpha^2) without the bias, n.h being all that is in float.
AngleStudy study_angle(double alpha, Normal normal) {
  constexpr int count = 200000;
  ListingDraws draws;
  AngleStudy study;
  for (int i = 0; i < count; ++i) {
    const ListingDraw draw = draws.within_lobe(alpha, alpha);
    const Geometry at = normal == Normal::z ? draw.at : turned(draw, draws.direction());
    const double exponent =
        listings::exponent_by_angle(listings::dot(at.n, listings::half_vector(at)));
    if (std::isnan(exponent)) {
      study.nan_share += 1.0 / count;
      continue;
    }
    const double truth = std::exp(-tangent_squared(at) / (alpha * alpha));
    study.worst = std::max(study.worst, std::abs(std::exp(exponent / (alpha * alpha)) - truth));
  }
  return study;
}

// A step of n.h, 6e-8, is 0.12 in the exponent; the half vector's own rounding adds another.
TEST(ListingsTest, TanOfAcosErrsByAQuarterOfThePeakAtTheSmallestRoughness) {
  const AngleStudy study = study_angle(1e-3, Normal::z);
  EXPECT_GT(study.worst, 0.20);
  EXPECT_LT(study.worst, 0.26);
  EXPECT_EQ(study.nan_share, 0);
}

// A normal with rounded components makes n.h rounder still, and lets it exceed 1.
TEST(ListingsTest, TanOfAcosErrsMoreForNormalsInGeneralAndIsNanInTheHighlight) {
  const AngleStudy study = study_angle(1e-3, Normal::anywhere);
  EXPECT_GT(study.worst, 0.26);
  EXPECT_LT(study.worst, 0.45);
  EXPECT_GT(study.nan_share, 2e-4);
  EXPECT_LT(study.nan_share, 2e-3);
}

TEST(ListingsTest, TanOfAcosHasItsOwnInfinityAtTheHorizonAndNanBeyondOne) {
  EXPECT_NEAR(-listings::exponent_by_angle(0), 5.2e14, 0.05e14);
  EXPECT_TRUE(std::isnan(
      listings::exponent_by_angle(std::nextafter(1.0F, std::numeric_limits<float>::infinity()))));
}

TEST(ListingsTest, WardIsNotANumberOrNegativeBelowTheHorizonWhereTheModelIs0) {
  const Float3 above{0.6F, 0, 0.8F};
  const Float3 below{0.6F, 0, -0.8F};
  for (const Geometry& at :
       {Geometry{{0, 0, 1}, below, above}, Geometry{{0, 0, 1}, above, below}}) {
    EXPECT_TRUE(std::isnan(listings::ward_isotropic(at, {0.5F, 0.5F, 0.2F})));
    EXPECT_TRUE(std::isnan(listings::ward_anisotropic(at, {0.5F, 0.5F, 0.2F, 0.3F})));
  }
  const Geometry both_below{{0, 0, 1}, below, {0, 0, -1}};
  EXPECT_LT(listings::ward_isotropic(both_below, {0.5F, 0.5F, 0.2F}), 0);
  EXPECT_LT(listings::ward_anisotropic(both_below, {0.5F, 0.5F, 0.2F, 0.3F}), 0);
}

/// The largest error of exp(exponent/alpha^2), whose peak is 1, over n.h from 0 to 1: the texture's
/// alone, the rest being in double. `bias` is added to alpha^2 on both sides.
double worst_texture_error(double alpha, listings::Addressing addressing, double bias = 0) {
  const auto texels = listings::ward_exponent_texels();
  const double r2 = alpha * alpha + bias;
  constexpr int steps = 100000;
  double worst = 0;
  for (int i = 1; i <= steps; ++i) {
    const float n_dot_h = static_cast<float>(i) / steps;
    const double stored = listings::exponent_by_texture(texels, n_dot_h, addressing);
    const double truth = 1 - 1 / (double{n_dot_h} * n_dot_h);
    worst = std::max(worst, std::abs(std::exp(stored / r2) - std::exp(truth / r2)));
  }
  return worst;
}

// Computed beforehand by another program, two or three digits each.
TEST(ListingsTest, WardTextureHasTheKnownErrors) {
  using listings::Addressing;
  EXPECT_NEAR(worst_texture_error(0.05, Addressing::clamp), 0.957, 5e-4);
  EXPECT_NEAR(worst_texture_error(0.1, Addressing::clamp), 0.544, 5e-4);
  EXPECT_NEAR(worst_texture_error(0.2, Addressing::clamp), 0.178, 5e-4);
  EXPECT_NEAR(worst_texture_error(0.4, Addressing::clamp), 0.048, 5e-4);
  EXPECT_NEAR(worst_texture_error(0.6, Addressing::clamp), 0.022, 5e-4);
  EXPECT_NEAR(worst_texture_error(1.0, Addressing::clamp), 0.0078, 5e-5);
  EXPECT_NEAR(worst_texture_error(0.05, Addressing::wrap), 0.792, 5e-4);
  // The listing's own bias changes the third digit.
  EXPECT_NEAR(worst_texture_error(0.05, Addressing::clamp, 1e-5), 0.956, 5e-4);
}

// In the arithmetic of the whole listing: c = 0 leaves the highlight.
TEST(ListingsTest, WardByTextureLosesTheHighlightOfASmoothSurface) {
  const auto texels = listings::ward_exponent_texels();
  const listings::WardMaterial smooth{0, 1, 0.05F};
  EXPECT_NEAR(listings::ward_isotropic_by_texture(facing, smooth, texels) /
                  listings::ward_isotropic(facing, smooth),
              1 - 0.956, 5e-4);
}

TEST(ListingsTest, WardTextureLeavesHalfOfItsTexelsUnread) {
  const auto texels = listings::ward_exponent_texels();
  auto poisoned = texels;
  std::fill_n(poisoned.begin(), 255, std::numeric_limits<float>::quiet_NaN());
  for (int i = 0; i <= 1000; ++i) {
    const float n_dot_h = static_cast<float>(i) / 1000;
    EXPECT_EQ(listings::exponent_by_texture(poisoned, n_dot_h),
              listings::exponent_by_texture(texels, n_dot_h));
  }
  EXPECT_NEAR(texels[256], -5.2e14, 0.05e14);  // acos(0)
}

// A texel of 512 over n.h from -1 to 1 is 1/256 wide.
TEST(ListingsTest, WardTextureIsReadHalfATexelOff) {
  const auto texels = listings::ward_exponent_texels();
  for (int i = 300; i < 512; ++i) {
    const float centre = static_cast<float>(2 * i + 1) / 512 - 1;
    const float exponent = listings::exponent_by_angle(centre - 1.0F / 512);
    EXPECT_NEAR(listings::exponent_by_texture(texels, centre), exponent, 1e-5 * std::abs(exponent));
  }
}

// The larger roughness acts along x, though roughness_x is the smaller one.
TEST(ListingsTest, WardAnisotropicIsTheApproximationWithTheAxesSwapped) {
  ListingDraws draws;
  constexpr float roughness_x = 0.05F;
  constexpr float roughness_y = 0.2F;
  const double ax = roughness_x + 1e-5;
  const double ay = roughness_y + 1e-5;
  for (int i = 0; i < 4000; ++i) {
    const ListingDraw draw = i % 2 == 0 ? draws.within_lobe(ay, ax) : draws.anywhere();
    const double diffuse = f_r<Lambert>({0.2}, {}, draw.wi, draw.wo);
    const double specular = f_r<AnisotropicWard<WardApproxLobe>>({0.4}, {ay, ax}, draw.wi, draw.wo);
    EXPECT_NEAR(listings::ward_anisotropic(draw.at, {0.2F, 0.4F, roughness_x, roughness_y}),
                draw.wi.z * (pi * diffuse + specular),
                1e-5 * draw.wi.z * (0.2 + 0.4 * ward_peak(ax, ay, draw)));
  }
}

/// A vector's components in the frame that the anisotropic listings make of the normal.
Direction<double> in_frame(const Float3& w, const Float3& n) {
  const listings::TangentFrame frame = listings::frame_from_epsilon(n);
  return {listings::dot(w, frame.tangent), listings::dot(w, frame.bitangent), listings::dot(w, n)};
}

TEST(ListingsTest, WardAnisotropicHasItsOwnFrameForEveryOtherNormal) {
  ListingDraws draws;
  constexpr float roughness_x = 0.1F;
  constexpr float roughness_y = 0.4F;
  for (int i = 0; i < 2000; ++i) {
    const ListingDraw draw = draws.within_lobe(0.4, 0.4);
    const Geometry at = turned(draw, draws.direction());
    const Direction<double> wi = in_frame(at.l, at.n);
    const Direction<double> wo = in_frame(at.v, at.n);
    const double peak = ward_peak(roughness_x, roughness_y, {at, wi, wo});
    EXPECT_NEAR(listings::ward_anisotropic(at, {0, 1, roughness_x, roughness_y}),
                wi.z * f_r<AnisotropicWard<WardApproxLobe>>({1}, {0.10001, 0.40001}, wi, wo),
                2e-5 * wi.z * peak);
  }
}

TEST(ListingsTest, WardAnisotropicLowersThePeakOfSmallRoughnesses) {
  const auto peak_of_model = [](double alpha) { return 1 / (4 * pi * alpha * alpha); };
  EXPECT_NEAR(listings::ward_anisotropic(facing, {0, 1, 1e-3F, 1e-3F}) / peak_of_model(1e-3), 0.98,
              5e-4);
  EXPECT_NEAR(listings::ward_anisotropic(facing, {0, 1, 1e-4F, 1e-4F}) / peak_of_model(1e-4), 0.826,
              5e-4);
}

TEST(ListingsTest, AnisotropicFrameIsDegenerateAtEpsilonAndTurnsAroundIt) {
  for (const float x : {1.0F, -1.0F}) {
    const Geometry at{{x, 0, 0}, {x, 0, 0}, {x, 0, 0}};
    EXPECT_TRUE(std::isnan(listings::ward_anisotropic(at, {0.5F, 0.5F, 0.2F, 0.3F})));
    EXPECT_TRUE(std::isnan(listings::ashikhmin_shirley(at, {.diffuse = 1, .nu = 10, .nv = 10})));
  }
  // Two normals that agree to 1e-3 have tangents at a right angle.
  const Float3 towards_y = listings::frame_from_epsilon({1, 1e-3F, 0}).tangent;
  const Float3 towards_z = listings::frame_from_epsilon({1, 0, 1e-3F}).tangent;
  EXPECT_NEAR(listings::dot(towards_y, towards_z), 0, 1e-6);
}

}  // namespace
}  // namespace gonio::tests
