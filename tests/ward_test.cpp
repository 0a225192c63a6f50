// The Ward family against 50-digit textbook formulas, closed forms and published albedos.
#include "brdf/ward.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/directions.h"
#include "tests/ward_reference.h"

namespace gonio::tests {
namespace {

using brdf::Direction;

struct Draw {
  Direction<double> wi, wo;
  double alpha_x, alpha_y;
};

/// Roughness log-uniform over 1e-3..1; every other half vector is drawn within the lobe, so that
/// sharp lobes are met and not only their dark surroundings.
class Draws {
 public:
  Draw next() {
    const double alpha_x = std::pow(10, uniform(-3, 0));
    const double alpha_y = std::pow(10, uniform(-3, 0));
    const Direction<double> wi = on_hemisphere();
    Direction<double> wo = on_hemisphere();
    if (count_++ % 2 == 0) {
      const double radius = std::sqrt(-std::log(uniform(1e-9, 1)));
      const double phi = uniform(0, 2 * std::numbers::pi);
      wo = mirrored_about_slopes(wi, alpha_x * radius * std::cos(phi),
                                 alpha_y * radius * std::sin(phi));
    }
    return wo.z > 0 ? Draw{wi, wo, alpha_x, alpha_y} : next();
  }

 private:
  double uniform(double lowest, double highest) {
    return std::uniform_real_distribution<double>(lowest, highest)(generator_);
  }

  Direction<double> on_hemisphere() {
    return brdf::direction_from_radians(std::acos(uniform(1e-3, 1)),
                                        uniform(0, 2 * std::numbers::pi));
  }

  std::mt19937_64 generator_{1992};
  int count_ = 0;
};

template <class Lobe>
class WardLobeTest : public testing::Test {};
using Lobes =
    testing::Types<brdf::WardLobe, brdf::WardApproxLobe, brdf::WardDuerLobe, brdf::WardGmdLobe>;
TYPED_TEST_SUITE(WardLobeTest, Lobes);

/// The largest error over draws, for values above 1e-12 of the lobe's peak, where the exponent is
/// at most 27.6. An error of k half-ulps in the exponent x becomes k x half-ulps of the value.
template <class D, class Lobe>
double worst_error(bool isotropic) {
  Draws draws;
  double worst = 0;
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {
    Draw draw = draws.next();
    if (isotropic) draw.alpha_y = draw.alpha_x;
    const auto wi = as<D>(draw.wi);
    const auto wo = as<D>(draw.wo);
    const D ax = static_cast<D>(draw.alpha_x);
    const D ay = static_cast<D>(draw.alpha_y);
    const D value = isotropic
                        ? brdf::IsotropicWard<Lobe>::template basis<D, D>({ax}, wi, wo)[0]
                        : brdf::AnisotropicWard<Lobe>::template basis<D, D>({ax, ay}, wi, wo)[0];
    const ReferenceValue truth = reference(Lobe{}, Digits(ax), Digits(ay), wi, wo);
    if (truth.exponent > std::log(1e12)) {
      // Beyond: as small as it should be, whatever its last digits.
      const Digits peak = truth.value * exp(truth.exponent);
      EXPECT_LE(Digits(value), 1.01 * truth.value + std::numeric_limits<D>::denorm_min() * peak);
      continue;
    }
    worst = std::max(worst, relative_error(value, truth.value));
    ++compared;
  }
  EXPECT_GT(compared, 1400) << "the draws miss the lobes";
  return worst;
}

// 27.6 times some 5 half-ulps of 1.1e-16 is 1.5e-14, of 6e-8 it is 8e-6.
TYPED_TEST(WardLobeTest, DoubleAgreesWithFiftyDigits) {
  EXPECT_LE((worst_error<double, TypeParam>(false)), 1e-13);
  EXPECT_LE((worst_error<double, TypeParam>(true)), 1e-13);
}

TYPED_TEST(WardLobeTest, FloatAgreesWithFiftyDigits) {
  EXPECT_LE((worst_error<float, TypeParam>(false)), 2e-5);
  EXPECT_LE((worst_error<float, TypeParam>(true)), 2e-5);
}

TYPED_TEST(WardLobeTest, IsReciprocalToRounding) {
  Draws draws;
  for (int i = 0; i < 4000; ++i) {
    const Draw d = draws.next();
    const double forth = TypeParam::value(d.alpha_x, d.alpha_y, d.wi, d.wo);
    const double back = TypeParam::value(d.alpha_x, d.alpha_y, d.wo, d.wi);
    // Sums commute exactly; only products may be associated differently.
    EXPECT_LE(std::abs(forth - back), 4 * std::numeric_limits<double>::epsilon() * forth);
  }
}

TYPED_TEST(WardLobeTest, IsExactlyZeroBelowTheHorizonAndOnIt) {
  const Direction<double> above = brdf::direction_from_degrees(30, 40);
  for (const double z : {0.0, -0.0, -1e-300, -0.5}) {
    const Direction<double> below{std::sqrt(1 - z * z), 0, z};
    using Isotropic = brdf::IsotropicWard<TypeParam>;
    using Anisotropic = brdf::AnisotropicWard<TypeParam>;
    EXPECT_EQ((Isotropic::template basis<double, double>({0.3}, below, above)[0]), 0);
    EXPECT_EQ((Isotropic::template basis<double, double>({0.3}, above, below)[0]), 0);
    EXPECT_EQ((Anisotropic::template basis<double, double>({0.3, 0.2}, below, above)[0]), 0);
    EXPECT_EQ((Anisotropic::template basis<double, double>({0.3, 0.2}, above, below)[0]), 0);
  }
}

TYPED_TEST(WardLobeTest, IsotropicIsAnisotropicWithEqualRoughness) {
  Draws draws;
  for (int i = 0; i < 100; ++i) {
    const Draw d = draws.next();
    using Isotropic = brdf::IsotropicWard<TypeParam>;
    using Anisotropic = brdf::AnisotropicWard<TypeParam>;
    EXPECT_EQ((Isotropic::template basis<double, double>({d.alpha_x}, d.wi, d.wo)),
              (Anisotropic::template basis<double, double>({d.alpha_x, d.alpha_x}, d.wi, d.wo)));
  }
}

TYPED_TEST(WardLobeTest, TurningTheSampleSwapsTheRoughnesses) {
  Draws draws;
  const auto turned = [](const Direction<double>& d) { return Direction<double>{-d.y, d.x, d.z}; };
  for (int i = 0; i < 100; ++i) {
    const Draw d = draws.next();
    EXPECT_DOUBLE_EQ(TypeParam::value(d.alpha_x, d.alpha_y, d.wi, d.wo),
                     TypeParam::value(d.alpha_y, d.alpha_x, turned(d.wi), turned(d.wo)));
  }
}

TEST(WardTest, TheReferenceAgreesWithTheAnglesOfTheHalfVector) {
  Draws draws;
  for (int i = 0; i < 200; ++i) {
    const Draw d = draws.next();
    const auto h = reference_half_vector(d.wi, d.wo);
    const Digits by_components = reference_exponent(h, d.alpha_x, d.alpha_y);
    const Digits by_angles = reference_exponent_by_angles(h, d.alpha_x, d.alpha_y);
    // acos of a cosine near 1 keeps half of the 50 digits.
    EXPECT_LE(abs(by_angles - by_components), 1e-18 * by_components);
  }
}

/// f_r at the mirror direction, where E = 1, over 1 / (4 pi ax ay): by the definition of each.
double mirror_factor(brdf::WardLobe /*lobe*/, double cosine) { return 1 / cosine; }
double mirror_factor(brdf::WardApproxLobe /*lobe*/, double cosine) { return 1 / cosine; }
double mirror_factor(brdf::WardDuerLobe /*lobe*/, double cosine) { return 1 / (cosine * cosine); }
double mirror_factor(brdf::WardGmdLobe /*lobe*/, double cosine) { return 1 / (cosine * cosine); }

TYPED_TEST(WardLobeTest, HasItsClosedFormPeakAtTheMirrorDirection) {
  for (const double theta : {0.0, 20.0, 45.0, 70.0, 89.0}) {
    const Direction<double> wi = brdf::direction_from_degrees(theta, 25);
    const Direction<double> wo{-wi.x, -wi.y, wi.z};
    const double expected = mirror_factor(TypeParam{}, wi.z) / (4 * std::numbers::pi * 0.05 * 0.16);
    EXPECT_NEAR(TypeParam::value(0.05, 0.16, wi, wo) / expected, 1, 1e-15);
  }
}

TYPED_TEST(WardLobeTest, JetDerivativesAgreeWithFiftyDigitDifferences) {
  using Jet = ceres::Jet<double, 2>;
  const Digits step("1e-15");  // truncation 1e-30 / alpha^2, cancellation 1e-35 of 50 digits
  Draws draws;
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    const Draw d = draws.next();
    const Jet jet = brdf::AnisotropicWard<TypeParam>::template basis<Jet, double>(
        {Jet(d.alpha_x, 0), Jet(d.alpha_y, 1)}, d.wi, d.wo)[0];
    const Digits ax(d.alpha_x);
    const Digits ay(d.alpha_y);
    const auto f = [&](const Digits& x, const Digits& y) {
      return reference(TypeParam{}, x, y, d.wi, d.wo).value;
    };
    const ReferenceValue truth = reference(TypeParam{}, ax, ay, d.wi, d.wo);
    if (truth.exponent > std::log(1e12)) continue;
    const Digits by_x = (f(ax + step, ay) - f(ax - step, ay)) / (2 * step);
    const Digits by_y = (f(ax, ay + step) - f(ax, ay - step)) / (2 * step);
    // f/alpha is the derivative's scale: the terms of 2 u^2 - 1 may cancel.
    const Digits scale = truth.value * (1 + truth.exponent);
    EXPECT_LE(abs(Digits(jet.v[0]) - by_x), 1e-13 * scale / ax);
    EXPECT_LE(abs(Digits(jet.v[1]) - by_y), 1e-13 * scale / ay);
    ++compared;
  }
  EXPECT_GT(compared, 150);
}

/// exp(-(tan(acos(n.h)) / alpha)^2) / (4 pi alpha^2 sqrt(cos_i cos_o)) in float, as many shaders
/// have it.
float through_the_angle(float alpha, const Direction<float>& wi, const Direction<float>& wo) {
  const auto h = brdf::half_vector(wi, wo);
  const float cosine = h.z / std::sqrt(h.x * h.x + h.y * h.y + h.z * h.z);
  const float tangent = std::tan(std::acos(std::min(cosine, 1.0F)));
  return std::exp(-tangent * tangent / (alpha * alpha)) /
         (4 * std::numbers::pi_v<float> * alpha * alpha * std::sqrt(wi.z * wo.z));
}

// n.h moves in steps of 6e-8, so tan^2 does in steps of 1.2e-7: at alpha = 1e-3 the exponent moves
// in steps of 0.12. Sharp lobes would show bands.
TEST(WardTest, ComponentsKeepTheSharpLobeThatTheAngleLosesInFloat) {
  constexpr float alpha = 1e-3F;
  double worst_naive = 0;
  double worst = 0;
  for (int i = 1; i <= 1000; ++i) {
    const Direction<float> wi = as<float>(brdf::direction_from_degrees(30, 0));
    const Direction<float> wo = as<float>(brdf::direction_from_degrees(30 + 2e-4 * i, 180));
    const Digits truth = reference(brdf::WardLobe{}, alpha, alpha, wi, wo).value;
    const float value = brdf::WardLobe::value(alpha, alpha, wi, wo);
    worst_naive = std::max(worst_naive, relative_error(through_the_angle(alpha, wi, wo), truth));
    worst = std::max(worst, relative_error(value, truth));
  }
  EXPECT_GT(worst_naive, 0.1);
  EXPECT_LT(worst, 2e-5);
}

/// The directional albedo for rho_s = 1 and equal roughnesses, by the midpoint rule: over theta
/// the integrand f cos sin is bounded also where f grows at grazing angles.
template <class Lobe>
double albedo(double alpha, double theta_i_deg) {
  constexpr int theta_count = 800;
  constexpr int phi_count = 800;  // over half the circle: the lobe is symmetric
  const Direction<double> wi = brdf::direction_from_degrees(theta_i_deg, 0);
  double sum = 0;
  for (int t = 0; t < theta_count; ++t) {
    const double theta = (t + 0.5) / theta_count * std::numbers::pi / 2;
    const double weight = std::cos(theta) * std::sin(theta);
    for (int p = 0; p < phi_count; ++p) {
      const double phi = (p + 0.5) / phi_count * std::numbers::pi;
      sum += weight * Lobe::value(alpha, alpha, wi, brdf::direction_from_radians(theta, phi));
    }
  }
  const double cell = std::numbers::pi / 2 / theta_count * std::numbers::pi / phi_count;
  return 2 * sum * cell;
}

struct AlbedoRow {
  double theta_deg, ward_01, ward_03, duer_03, gmd_01, gmd_03;
};

// Converged quadratures of the formulas by another program, printed with 3 digits.
TEST(WardTest, HasThePublishedDirectionalAlbedos) {
  constexpr AlbedoRow rows[] = {{0, .971, .794, .856, .990, .910},
                                {30, .842, .691, .855, .988, .893},
                                {60, .489, .422, .824, .974, .819},
                                {75, .259, .280, .838, .918, .778}};
  constexpr double rounding = 0.00051;
  for (const AlbedoRow& row : rows) {
    SCOPED_TRACE(row.theta_deg);
    EXPECT_NEAR(albedo<brdf::WardLobe>(0.1, row.theta_deg), row.ward_01, rounding);
    EXPECT_NEAR(albedo<brdf::WardLobe>(0.3, row.theta_deg), row.ward_03, rounding);
    EXPECT_NEAR(albedo<brdf::WardDuerLobe>(0.3, row.theta_deg), row.duer_03, rounding);
    EXPECT_NEAR(albedo<brdf::WardGmdLobe>(0.1, row.theta_deg), row.gmd_01, rounding);
    EXPECT_NEAR(albedo<brdf::WardGmdLobe>(0.3, row.theta_deg), row.gmd_03, rounding);
  }
}

}  // namespace
}  // namespace gonio::tests
