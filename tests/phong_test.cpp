// Phong's and Blinn's lobes against 50-digit powers, closed-form normalisations, and the plain
// power of a cosine in float.
#include "brdf/phong.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/directions.h"
#include "tests/extreme_directions.h"
#include "tests/phong_reference.h"

namespace gonio::tests {
namespace {

using brdf::Direction;

template <class T, class D>
D lobe(D exponent, const Direction<D>& wi, const Direction<D>& wo) {
  return T::template basis<D, D>({exponent}, wi, wo)[0];
}

/// The half vector is as far from the normal as half the viewer is from the mirror direction: a
/// cosine lobe of the width 1/sqrt(n) there is one of this width over its slopes.
double slope_width(brdf::Phong /*lobe*/, double n) { return 0.5 / std::sqrt(n + 1); }
double slope_width(brdf::BlinnPhong /*lobe*/, double n) { return 1 / std::sqrt(n + 1); }

struct Draw {
  Direction<double> wi, wo;
  double exponent;
};

/// Exponents from 0 up, 1 + n log-uniform; every other pair of directions within the lobe, so that
/// sharp lobes are met and not only their dark surroundings.
template <class T>
class Draws {
 public:
  explicit Draws(double largest_exponent) : largest_exponent_(largest_exponent) {}

  Draw next() {
    const double n = std::expm1(uniform(0, std::log1p(largest_exponent_)));
    const Direction<double> wi = on_hemisphere();
    Direction<double> wo = on_hemisphere();
    if (count_++ % 2 == 0) {
      const double radius = slope_width(T{}, n) * std::sqrt(-2 * std::log(uniform(1e-9, 1)));
      const double phi = uniform(0, 2 * std::numbers::pi);
      wo = mirrored_about_slopes(wi, radius * std::cos(phi), radius * std::sin(phi));
    }
    return wo.z > 0 ? Draw{wi, wo, n} : next();
  }

 private:
  double uniform(double lowest, double highest) {
    return std::uniform_real_distribution<double>(lowest, highest)(generator_);
  }
  Direction<double> on_hemisphere() {
    return brdf::direction_from_radians(std::acos(uniform(1e-3, 1)),
                                        uniform(0, 2 * std::numbers::pi));
  }

  std::mt19937_64 generator_{1975};
  double largest_exponent_;
  int count_ = 0;
};

template <class T>
class CosineLobe : public testing::Test {};
using CosineLobes = testing::Types<brdf::Phong, brdf::BlinnPhong>;
TYPED_TEST_SUITE(CosineLobe, CosineLobes);

struct Errors {
  double relative = 0;  // of values above 1e-12, the peak being 1
  double of_peak = 0;
};

/// The share by which a value may err beyond the common bound because its cosine c does. The sum
/// r.wo of three products, whose sizes add up to at most 1, errs by 4 half-ulps of 1 whatever its
/// own size; the power n multiplies that.
template <class D>
double cosine_condition(brdf::Phong /*lobe*/, double n, double cosine) {
  return cosine < 0.5 ? 2 * n * double{std::numeric_limits<D>::epsilon()} / cosine : 0;
}
template <class D>
double cosine_condition(brdf::BlinnPhong /*lobe*/, double /*n*/, double /*cosine*/) {
  return 0;
}

/// The worst errors over draws, beyond those that the cosine's condition excuses.
template <class D, class T>
Errors worst_errors(double largest_exponent) {
  Draws<T> draws(largest_exponent);
  Errors worst;
  int compared = 0;
  for (int i = 0; i < 6000; ++i) {
    const Draw draw = draws.next();
    const auto wi = as<D>(draw.wi);
    const auto wo = as<D>(draw.wo);
    const D n = static_cast<D>(draw.exponent);
    const Digits cosine = reference_cosine(T{}, wi, wo);
    const Digits truth = reference_power(cosine, exact(n));
    const D value = lobe<T>(n, wi, wo);
    // A cosine of rounding's own size has no sign; no draw has one but by chance.
    if (abs(cosine) < 4 * std::numeric_limits<D>::epsilon()) continue;
    if (truth < 1e-12) {
      EXPECT_LE(exact(value), 1.01 * truth + std::numeric_limits<D>::denorm_min());
      continue;
    }
    const double excused =
        cosine_condition<D>(T{}, double{n}, cosine.template convert_to<double>());
    const double error = std::max(0.0, relative_error(value, truth) - excused);
    worst.relative = std::max(worst.relative, error);
    worst.of_peak = std::max(worst.of_peak, error * truth.template convert_to<double>());
    ++compared;
  }
  EXPECT_GT(compared, 2800) << "the draws miss the lobes";
  return worst;
}

// -ln of a value above 1e-12 is at most 27.6; some 10 half-ulps of 1.1e-16 of that are 3e-14.
TYPED_TEST(CosineLobe, DoubleAgreesWithFiftyDigits) {
  EXPECT_LE((worst_errors<double, TypeParam>(1e6).relative), 1e-13);
  EXPECT_LE((worst_errors<double, TypeParam>(2).relative), 1e-13) << "small exponents";
}

// x exp(-x) is at most 0.37: 10 half-ulps of 6e-8 of that are 2e-7.
TYPED_TEST(CosineLobe, FloatAgreesWithFiftyDigitsToAFewMillionthsOfThePeak) {
  EXPECT_LE((worst_errors<float, TypeParam>(1e6).of_peak), 5e-7);
  EXPECT_LE((worst_errors<float, TypeParam>(2).of_peak), 5e-7) << "small exponents";
}

TYPED_TEST(CosineLobe, IsReciprocal) {
  Draws<TypeParam> draws(1e6);
  for (int i = 0; i < 4000; ++i) {
    const Draw d = draws.next();
    EXPECT_DOUBLE_EQ(lobe<TypeParam>(d.exponent, d.wi, d.wo),
                     lobe<TypeParam>(d.exponent, d.wo, d.wi));
  }
}

TYPED_TEST(CosineLobe, IsExactlyOneAtTheMirrorDirection) {
  for (const double theta : {0.0, 20.0, 45.0, 89.0, 89.999}) {
    const Direction<double> wi = brdf::direction_from_degrees(theta, 25);
    const Direction<double> wo{-wi.x, -wi.y, wi.z};
    for (const double n : {0.0, 1e-300, 1.0, 1e6}) EXPECT_EQ(lobe<TypeParam>(n, wi, wo), 1);
  }
}

TYPED_TEST(CosineLobe, IsExactlyZeroBelowTheHorizonAndOnIt) {
  const Direction<double> above = brdf::direction_from_degrees(30, 40);
  for (const double z : {0.0, -0.0, -1e-300, -0.5}) {
    const Direction<double> below{std::sqrt(1 - z * z), 0, z};
    for (const double n : {0.0, 10.0}) {
      EXPECT_EQ(lobe<TypeParam>(n, below, above), 0);
      EXPECT_EQ(lobe<TypeParam>(n, above, below), 0);
    }
  }
}

TYPED_TEST(CosineLobe, OfExponentZeroIsOneWhereverItsCosineIsPositive) {
  Draws<TypeParam> draws(1);
  int dark = 0;
  for (int i = 0; i < 2000; ++i) {
    const Draw d = draws.next();
    const bool lit = reference_cosine(TypeParam{}, d.wi, d.wo) > 0;
    EXPECT_EQ(lobe<TypeParam>(0.0, d.wi, d.wo), lit ? 1 : 0);
    dark += lit ? 0 : 1;
  }
  // Half of the free pairs, an eighth of all or more, face away from each other's mirror image.
  EXPECT_TRUE((std::is_same_v<TypeParam, brdf::BlinnPhong>) ? dark == 0 : dark > 250);
}

// d/dn c^n = c^n ln c.
TYPED_TEST(CosineLobe, JetDerivativeAgreesWithTheClosedForm) {
  using Jet = ceres::Jet<double, 1>;
  Draws<TypeParam> draws(1e6);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const Draw d = draws.next();
    const Jet jet = TypeParam::template basis<Jet, double>({Jet(d.exponent, 0)}, d.wi, d.wo)[0];
    const Digits cosine = reference_cosine(TypeParam{}, d.wi, d.wo);
    const Digits value = reference_power(cosine, Digits(d.exponent));
    if (value < 1e-12) continue;
    const Digits derivative = value * log(cosine);
    const double c = cosine.convert_to<double>();
    // ln c errs by 1/|ln c| < 1.5 times the relative error of c, c^n by n times.
    const double excused = cosine_condition<double>(TypeParam{}, d.exponent + 1.5, c);
    EXPECT_LE(abs(jet.v[0] - derivative), (1e-13 + excused) * abs(derivative) + 1e-300);
    ++compared;
  }
  EXPECT_GT(compared, 900);
}

template <class T, class D>
void expect_sane_everywhere() {
  using Jet = ceres::Jet<D, 1>;
  DirectionPairs<D> pairs(7, std::numeric_limits<D>::denorm_min());
  for (int i = 0; i < 50'000; ++i) {
    const DirectionPair<D> pair = pairs.next();
    for (const D n : {D(0), std::numeric_limits<D>::min(), pairs.uniform(0, 1), D(1e3), D(1e6)}) {
      const Jet jet = T::template basis<Jet, D>({Jet(n, 0)}, pair.wi, pair.wo)[0];
      const D value = lobe<T>(n, pair.wi, pair.wo);
      ASSERT_TRUE(value >= 0 && value <= 1) << value << " at exponent " << n;
      ASSERT_TRUE(std::isfinite(jet.v[0]) && jet.v[0] <= 0) << jet.v[0] << " at exponent " << n;
    }
  }
}

TYPED_TEST(CosineLobe, DoubleIsSaneWhereNumbersRunOutOfRange) {
  expect_sane_everywhere<TypeParam, double>();
}
TYPED_TEST(CosineLobe, FloatIsSaneWhereNumbersRunOutOfRange) {
  expect_sane_everywhere<TypeParam, float>();
}

// q = tan^2 overflows from a cosine of 1e-154 (float: 1e-19) on; small powers are not yet small.
TEST(BlinnPhongTest, KeepsSmallPowersOfTheSmallestCosines) {
  const auto value = [](auto cosine, auto n) {
    using D = decltype(cosine);
    const Direction<D> grazing{1, 0, cosine};
    return lobe<brdf::BlinnPhong>(n, grazing, grazing);
  };
  EXPECT_NEAR(value(1e-200, 0.01), 1e-2, 1e-15);
  EXPECT_NEAR(value(1e-300, 0.01), 1e-3, 1e-15);
  EXPECT_NEAR(value(1e-30F, 0.1F), 1e-3F, 2e-9F);  // the power's argument is 69 half-ulps of 6e-8
}

/// The albedo at normal incidence of a lobe that depends on theta_o only: the midpoint rule over
/// 2 pi f_r cos sin.
template <class T>
double albedo_at_normal_incidence(double exponent) {
  constexpr int count = 200'000;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double theta = (i + 0.5) / count * std::numbers::pi / 2;
    sum += lobe<T>(exponent, {0, 0, 1}, brdf::direction_from_radians(theta, 0.3)) *
           std::cos(theta) * std::sin(theta);
  }
  return 2 * std::numbers::pi * sum * (std::numbers::pi / 2) / count;
}

constexpr double some_exponents[] = {0, 0.5, 1, 10, 100, 1e4, 1e6};
// The midpoint rule's h^2/24 (f'(b) - f'(a)), h = 8e-6, f' up to 1e6 at the normal.
constexpr double quadrature_error = 5e-6;

// Lafortune & Willems 1994.
TEST(PhongTest, TimesItsNormalisationHasAlbedoOneAtNormalIncidence) {
  for (const double n : some_exponents) {
    EXPECT_NEAR((n + 2) / (2 * std::numbers::pi) * albedo_at_normal_incidence<brdf::Phong>(n), 1,
                quadrature_error)
        << n;
  }
}

TEST(BlinnPhongTest, TimesItsNormalisationHasAlbedoOneAtNormalIncidence) {
  for (const double n : some_exponents) {
    const double normalisation =
        (n + 2) * (n + 4) / (8 * std::numbers::pi * (std::exp2(-n / 2) + n));
    EXPECT_NEAR(normalisation * albedo_at_normal_incidence<brdf::BlinnPhong>(n), 1,
                quadrature_error)
        << n;
  }
}

/// The power of the cosine itself.
float plain_power(brdf::Phong /*lobe*/, float n, const Direction<float>& wi,
                  const Direction<float>& wo) {
  return std::pow(std::max(0.0F, wi.z * wo.z - wi.x * wo.x - wi.y * wo.y), n);
}
float plain_power(brdf::BlinnPhong /*lobe*/, float n, const Direction<float>& wi,
                  const Direction<float>& wo) {
  const auto h = brdf::half_vector(wi, wo);
  return std::pow(h.z / std::sqrt(h.x * h.x + h.y * h.y + h.z * h.z), n);
}

// A cosine near 1 moves in steps of 6e-8, its power 1e4 in steps of 6e-4: sharp lobes show bands.
TYPED_TEST(CosineLobe, KeepsTheSharpLobeThatThePlainPowerLosesInFloat) {
  constexpr float exponent = 1e4F;
  double worst_plain = 0;
  double worst = 0;
  for (int i = 0; i <= 1000; ++i) {
    const auto wi = as<float>(brdf::direction_from_degrees(30, 0));
    const auto wo = as<float>(brdf::direction_from_degrees(30 + 1e-3 * i, 180));
    const Digits truth = reference_power(reference_cosine(TypeParam{}, wi, wo), exponent);
    const auto error_of = [&](float value) {
      return abs(exact(value) - truth).template convert_to<double>();
    };
    worst_plain = std::max(worst_plain, error_of(plain_power(TypeParam{}, exponent, wi, wo)));
    worst = std::max(worst, error_of(lobe<TypeParam>(exponent, wi, wo)));
  }
  EXPECT_GT(worst_plain, 3e-4);
  EXPECT_LT(worst, 5e-7);
}

}  // namespace
}  // namespace gonio::tests
