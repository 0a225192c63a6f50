// Oren and Nayar's two forms against 50-digit textbook formulas, closed forms and published facts.
#include "brdf/oren_nayar.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/directions.h"
#include "tests/extreme_directions.h"
#include "tests/oren_nayar_reference.h"

namespace gonio::tests {
namespace {

using brdf::Direction;
using brdf::OrenNayar;
using brdf::OrenNayarFull;

static_assert(brdf::Term<OrenNayar> && brdf::Term<OrenNayarFull>);

constexpr double half_pi = std::numbers::pi / 2;
constexpr double smallest_cosine = 1.7e-5;  // 89.999 deg
/// C1 is at least 1 - 0.5 * 2.4674 / 2.7974: what the shares that cancel are compared with.
constexpr double least_c1 = 0.5589 / std::numbers::pi;

/// sigma over its whole range; a share of the draws at its bounds.
template <class D>
D drawn_sigma(DirectionPairs<D>& draws) {
  const D sigma = draws.uniform(D(-0.2), D(half_pi + 0.2));
  return std::clamp(sigma, D(0), D(half_pi));
}

/// |value - truth| over the truth or over `least`, whichever is larger; saturated values and those
/// that are clamped at 0 are right.
template <class D, class N>
double error(D value, const N& truth, double least) {
  const N largest = exact_in<N>(std::numeric_limits<D>::max());
  const N expected = truth < 0 ? N(0) : truth < largest ? truth : largest;
  const N scale = expected < least ? N(least) : expected;
  return N(abs(exact_in<N>(value) - expected) / scale).template convert_to<double>();
}

struct Errors {
  double simplified = 0, direct = 0, interreflection = 0;
  double all() const { return std::max({simplified, direct, interreflection}); }
};

template <class D, class N>
Errors errors(const D& sigma, const DirectionPair<D>& pair) {
  const N exact_sigma = exact_in<N>(sigma);
  const auto angles = reference_angles<N>(pair.wi, pair.wo);
  const auto truth = reference_full_oren_nayar(exact_sigma, angles);
  const auto full = OrenNayarFull::basis<D, D>({sigma}, pair.wi, pair.wo);
  const D simplified = OrenNayar::basis<D, D>({sigma}, pair.wi, pair.wo)[0];
  return {error(simplified, reference_oren_nayar(exact_sigma, angles), 0),
          error(full[0], truth.direct, least_c1), error(full[1], truth.interreflection, 0)};
}

template <class D, class N>
double worst_error(D least_cosine, int count) {
  DirectionPairs<D> draws(1994, least_cosine);
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const auto pair = draws.next();
    worst = std::max(worst, errors<D, N>(drawn_sigma(draws), pair).all());
  }
  return worst;
}

// Some 10 to 20 roundings. Relative to the value, except where direct light cancels: there to C1.
TEST(OrenNayarTest, DoubleAgreesWithFiftyDigits) {
  EXPECT_LE((worst_error<double, Digits>(smallest_cosine, 6000)), 1e-14);
}

TEST(OrenNayarTest, FloatAgreesWithFiftyDigits) {
  EXPECT_LE((worst_error<float, Digits>(static_cast<float>(smallest_cosine), 6000)), 2e-6);
}

// Down to the smallest normal cosine: beyond it 1/cos saturates.
TEST(OrenNayarTest, IsRightOrSaturatedAtTheSmallestCosines) {
  EXPECT_LE((worst_error<double, ManyDigits>(1e-300, 150)), 1e-14);
  EXPECT_LE((worst_error<float, ManyDigits>(1e-36F, 150)), 2e-6);
}

// Where the azimuths are perpendicular the dot product of the horizontal components cancels, and
// its rounding, half an epsilon, is divided by cos(b).
TEST(OrenNayarTest, PerpendicularAzimuthsAtGrazingErrByTheRoundingOverTheCosine) {
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  double worst = 0;
  for (int i = 1; i < 200; ++i) {
    const double phi = 90 - 1e-5 * i;
    const DirectionPair<double> pair{brdf::direction_from_degrees(89.999, 33),
                                     brdf::direction_from_degrees(89.999, 33 + phi)};
    worst = std::max(worst, errors<double, Digits>(1, pair).all());
  }
  EXPECT_LE(worst, rounding / smallest_cosine);
  EXPECT_LE(worst, 1e-11);
}

template <class D>
void expect_finite_and_not_negative() {
  DirectionPairs<D> draws(33, std::numeric_limits<D>::denorm_min());
  for (int i = 0; i < 200000; ++i) {
    const auto [wi, wo] = draws.next();
    const D sigma = drawn_sigma(draws);
    const auto full = OrenNayarFull::basis<D, D>({sigma}, wi, wo);
    for (const D value : {OrenNayar::basis<D, D>({sigma}, wi, wo)[0], full[0], full[1]}) {
      ASSERT_TRUE(std::isfinite(value) && value >= 0)
          << value << " at sigma " << sigma << ", wi " << wi.x << ' ' << wi.y << ' ' << wi.z
          << ", wo " << wo.x << ' ' << wo.y << ' ' << wo.z;
    }
  }
}

TEST(OrenNayarTest, IsFiniteAndNotNegativeInDouble) { expect_finite_and_not_negative<double>(); }
TEST(OrenNayarTest, IsFiniteAndNotNegativeInFloat) { expect_finite_and_not_negative<float>(); }

TEST(OrenNayarTest, IsExactlyZeroBelowTheHorizonAndOnIt) {
  const Direction<double> above = brdf::direction_from_degrees(30, 40);
  for (const double z : {0.0, -0.0, -1e-300, -0.5}) {
    const Direction<double> below{std::sqrt(1 - z * z), 0, z};
    EXPECT_EQ((OrenNayar::basis<double, double>({0.5}, below, above)[0]), 0);
    EXPECT_EQ((OrenNayar::basis<double, double>({0.5}, above, below)[0]), 0);
    EXPECT_EQ((OrenNayarFull::basis<double, double>({0.5}, below, above)),
              (std::array<double, 2>{0, 0}));
    EXPECT_EQ((OrenNayarFull::basis<double, double>({0.5}, above, below)),
              (std::array<double, 2>{0, 0}));
  }
}

TEST(OrenNayarTest, ASmoothSurfaceIsLambertsExactly) {
  DirectionPairs<double> draws(1760, 1e-300);
  for (int i = 0; i < 20000; ++i) {
    const auto [wi, wo] = draws.next();
    const double lambert = brdf::Lambert::basis<double, double>({}, wi, wo)[0];
    EXPECT_EQ((OrenNayar::basis<double, double>({0}, wi, wo)[0]), lambert);
    EXPECT_EQ((OrenNayarFull::basis<double, double>({0}, wi, wo)),
              (std::array<double, 2>{lambert, 0}));
  }
}

TEST(OrenNayarTest, IsReciprocal) {
  DirectionPairs<double> draws(1856, smallest_cosine);
  for (int i = 0; i < 20000; ++i) {
    const auto [wi, wo] = draws.next();
    const double sigma = drawn_sigma(draws);
    EXPECT_EQ((OrenNayar::basis<double, double>({sigma}, wi, wo)),
              (OrenNayar::basis<double, double>({sigma}, wo, wi)));
    const auto forth = OrenNayarFull::basis<double, double>({sigma}, wi, wo);
    const auto back = OrenNayarFull::basis<double, double>({sigma}, wo, wi);
    // Of two directions at the same angle either may be taken as the one nearer to the pole.
    constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
    EXPECT_NEAR(forth[0], back[0], rounding * std::max(forth[0], least_c1));
    EXPECT_NEAR(forth[1], back[1], rounding * forth[1]);
  }
}

// sigma = 20 deg: s2 = 0.121847, A = 1 - 0.5 s2 / (s2 + 0.33), B = 0.45 s2 / (s2 + 0.09); by hand.
TEST(OrenNayarTest, HasThePublishedCoefficients) {
  constexpr double sigma = 20 * std::numbers::pi / 180;
  constexpr double a = 0.865168;
  constexpr double b = 0.258824;
  const auto value = [](const Direction<double>& wi, const Direction<double>& wo) {
    return std::numbers::pi * OrenNayar::basis<double, double>({sigma}, wi, wo)[0];
  };
  const auto at = brdf::direction_from_degrees;
  EXPECT_NEAR(value({0, 0, 1}, at(50, 10)), a, 1e-6);
  EXPECT_NEAR(value(at(45, 70), at(45, 70)), a + b * std::numbers::sqrt2 / 2, 1e-6);
  // max = 60 deg, min = 30 deg, dphi = 60 deg: sin max tan min cos dphi = 1/4.
  EXPECT_NEAR(value(at(60, 10), at(30, 70)), a + b / 4, 1e-6);
  EXPECT_NEAR(value(at(60, 0), at(30, 120)), a, 1e-6) << "flat on the other side";
}

/// The largest departure of the simplified form from the full one for an albedo of 0.7, relative to
/// the latter, over polar angles up to `limit` degrees.
double departure_up_to(double limit) {
  double worst = 0;
  for (double theta_i = 0; theta_i <= limit; theta_i += 10) {
    for (double theta_o = 0; theta_o <= limit; theta_o += 10) {
      for (double phi = 0; phi <= 180; phi += 15) {
        const auto wi = brdf::direction_from_degrees(theta_i, 0);
        const auto wo = brdf::direction_from_degrees(theta_o, phi);
        const auto [direct, indirect] = OrenNayarFull::basis<double, double>({0.3}, wi, wo);
        const double simplified = OrenNayar::basis<double, double>({0.3}, wi, wo)[0];
        worst = std::max(worst, std::abs(simplified / (direct + 0.7 * indirect) - 1));
      }
    }
  }
  return worst;
}

// At sigma = 0.3 it leaves out 0.7 * 0.17 * 0.41 = 0.05 of interreflection and, on the opposite
// side, C2 tan(b) = 0.07 at 30 deg and 0.22 at 60 deg, of some 0.9.
TEST(OrenNayarTest, TheSimplifiedFormIsNearTheFullOne) {
  EXPECT_LT(departure_up_to(30), 0.08);
  EXPECT_LT(departure_up_to(60), 0.25);
  EXPECT_GT(departure_up_to(30), 0.01) << "they are two models";
}

TEST(OrenNayarTest, TheFullFormIsQuadraticInTheAlbedo) {
  EXPECT_EQ(OrenNayarFull::coefficients<double>({0.5}), (std::array<double, 2>{0.5, 0.25}));
  EXPECT_EQ(OrenNayarFull::description.coefficients, brdf::Coefficients::nonlinear);
}

struct Published {
  double least = 1;  // of the direct light, unclamped, times pi
  double both = 1;   // least sum with the interreflection for rho = 1, times pi
};

/// Over polar angles up to 89.9 deg, and closer to the horizon where both are equal.
Published least_published(double sigma) {
  Published result;
  const auto look = [&](double theta_i, double theta_o, double phi) {
    const auto truth = reference_full_oren_nayar(
        sigma, ReferenceAngles<double>{std::max(theta_i, theta_o), std::min(theta_i, theta_o),
                                       std::cos(phi)});
    result.least = std::min(result.least, std::numbers::pi * truth.direct);
    result.both = std::min(result.both, std::numbers::pi * (truth.direct + truth.interreflection));
  };
  constexpr double degree = std::numbers::pi / 180;
  for (int i = 1; i <= 90; ++i) {
    for (int o = 1; o <= 90; ++o) {
      for (int p = 90; p <= 180; ++p) look((i - 0.1) * degree, (o - 0.1) * degree, p * degree);
    }
  }
  look(half_pi - 1e-6, half_pi - 1e-6, std::numbers::pi);
  return result;
}

// 1 - 0.5 s2/(s2+0.33) = 0.45 s2/(s2+0.09) * 6/pi at sigma = 0.6644: there the limit of grazing
// directions opposite each other is 0.
TEST(OrenNayarTest, ThePublishedDirectLightIsNegativeForRoughSurfacesOnly) {
  EXPECT_GT(least_published(0.664).least, 0);
  EXPECT_LT(least_published(0.665).least, 0);
  const Published roughest = least_published(half_pi);
  EXPECT_NEAR(roughest.least, -0.2702, 1e-4);  // over pi: the 0.0861 of the header
  EXPECT_GT(roughest.both, 0) << "a white surface never reflects less than nothing";
}

TEST(OrenNayarTest, DirectLightIsZeroWhereThePublishedOneIsNegative) {
  const auto wi = brdf::direction_from_degrees(80, 0);
  const auto wo = brdf::direction_from_degrees(80, 180);
  const auto truth = reference_full_oren_nayar(Digits(1), reference_angles<Digits>(wi, wo));
  EXPECT_LT(truth.direct, -0.01);
  const auto value = OrenNayarFull::basis<double, double>({1}, wi, wo);
  EXPECT_EQ(value[0], 0);
  EXPECT_LE(error(value[1], truth.interreflection, 0), 1e-14);
}

/// As printed, in float: the angles by acos and atan2, then the formula.
ReferenceAngles<float> angles_by_acos(const Direction<float>& wi, const Direction<float>& wo) {
  const float theta_i = std::acos(wi.z);
  const float theta_o = std::acos(wo.z);
  const float dphi = std::atan2(wi.y, wi.x) - std::atan2(wo.y, wo.x);
  return {std::max(theta_i, theta_o), std::min(theta_i, theta_o), std::cos(dphi)};
}

TEST(OrenNayarTest, ComponentsKeepTheDigitsThatTheAnglesLoseInFloat) {
  double worst = 0;
  double worst_naive = 0;
  double worst_naive_simplified = 0;
  for (int i = 0; i < 1000; ++i) {
    const double theta = 90 - std::pow(10, -0.003 * i);  // from 89 to 89.999 deg
    const DirectionPair<float> pair{as<float>(brdf::direction_from_degrees(theta, 20)),
                                    as<float>(brdf::direction_from_degrees(theta, 80))};
    const auto angles = reference_angles<Digits>(pair.wi, pair.wo);
    const auto naive = angles_by_acos(pair.wi, pair.wo);
    worst = std::max(worst, errors<float, Digits>(0.5F, pair).all());
    worst_naive = std::max(worst_naive,
                           error(reference_full_oren_nayar(0.5F, naive).direct,
                                 reference_full_oren_nayar(Digits(0.5), angles).direct, least_c1));
    worst_naive_simplified = std::max(
        worst_naive_simplified,
        error(reference_oren_nayar(0.5F, naive), reference_oren_nayar(Digits(0.5), angles), 0));
  }
  EXPECT_LT(worst, 2e-6);
  // Half a last digit of an angle next to pi/2 is 6e-8: 0.35 % of a cosine of 1.7e-5.
  EXPECT_GT(worst_naive, 1e-3);
  EXPECT_GT(worst_naive_simplified, 1e-3);
}

// van Ouwerkerk's rewrite normalises the projections of both directions: 0/0 at the pole.
TEST(OrenNayarTest, TheVectorFormHasNoPole) {
  const Direction<float> pole{0, 0, 1};
  const float length = std::hypot(pole.x, pole.y);
  EXPECT_TRUE(std::isnan(pole.x / length)) << "what a normalised projection holds";
  const auto wo = as<float>(brdf::direction_from_degrees(50, 10));
  const double expected = (1 - 0.5 * 0.25 / 0.58) / std::numbers::pi;  // A / pi at sigma = 0.5
  EXPECT_NEAR((OrenNayar::basis<float, float>({0.5F}, pole, wo)[0]), expected, 1e-7);
  EXPECT_NEAR((OrenNayar::basis<float, float>({0.5F}, wo, pole)[0]), expected, 1e-7);
}

TEST(OrenNayarTest, JetDerivativesAgreeWithFiftyDigitDifferences) {
  using Jet = ceres::Jet<double, 1>;
  const Digits step("1e-15");  // truncation 1e-30, cancellation 1e-35 of 50 digits
  DirectionPairs<double> draws(7, 1e-3);
  for (int i = 0; i < 500; ++i) {
    const auto [wi, wo] = draws.next();
    const double sigma = draws.uniform(0, half_pi);
    const auto angles = reference_angles<Digits>(wi, wo);
    const auto simplified = [&](const Digits& s) { return reference_oren_nayar(s, angles); };
    const auto full = [&](const Digits& s) { return reference_full_oren_nayar(s, angles); };
    const auto above = full(sigma + step);
    const auto below = full(sigma - step);
    const Digits expected[] = {
        (simplified(sigma + step) - simplified(sigma - step)) / (2 * step),
        above.direct > 0 ? Digits((above.direct - below.direct) / (2 * step)) : Digits(0),
        (above.interreflection - below.interreflection) / (2 * step)};
    const auto jets = OrenNayarFull::basis<Jet, double>({Jet(sigma, 0)}, wi, wo);
    const Jet values[] = {OrenNayar::basis<Jet, double>({Jet(sigma, 0)}, wi, wo)[0], jets[0],
                          jets[1]};
    for (int k = 0; k < 3; ++k) {
      // Shares of either sign: each derivative is at most some 3 times the value's own scale.
      const double scale = std::max(values[k].a, least_c1);
      EXPECT_LE(abs(Digits(values[k].v[0]) - expected[k]), 1e-13 * scale) << k;
    }
  }
}

TEST(OrenNayarTest, JetDerivativesAreFiniteAtEveryExtreme) {
  using Jet = ceres::Jet<double, 3>;
  DirectionPairs<double> draws(77, std::numeric_limits<double>::denorm_min());
  for (int i = 0; i < 50000; ++i) {
    const auto [wi, wo] = draws.next();
    const Jet sigma(drawn_sigma(draws), 0);
    const auto full = OrenNayarFull::basis<Jet, double>({sigma}, wi, wo);
    for (const Jet& value : {OrenNayar::basis<Jet, double>({sigma}, wi, wo)[0], full[0], full[1]}) {
      ASSERT_TRUE(std::isfinite(value.a) && value.v.allFinite())
          << value << " at sigma " << sigma << ", cosines " << wi.z << ", " << wo.z;
    }
  }
}

}  // namespace
}  // namespace gonio::tests
