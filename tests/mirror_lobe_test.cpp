// Powers of the mirror cosine against 50 digits on normalised vectors, sharp lobes above all.
#include "brdf/mirror_lobe.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/extreme_directions.h"
#include "tests/strauss_reference.h"

namespace gonio::tests {
namespace {

using brdf::Direction;

double lobe(const DirectionPair<double>& pair, double exponent) {
  return brdf::power(brdf::mirror_cosine(pair.wi, pair.wo), exponent);
}

Digits mirror_cosine_in_digits(const DirectionPair<double>& pair) {
  return strauss_angles<Digits>(true, pair.wi, pair.wo).mirror_cosine;
}

/// |value - truth| as a fraction of the lobe's peak, which is 1.
double error(double value, const Digits& truth) {
  return abs(Digits(value - truth)).convert_to<double>();
}

// With -ln C = x / n the value is exp(-x): x epsilon exp(-x) is at most 0.37 epsilon, for each of
// the few roundings of x. The power of the dot product shows n epsilon.
TEST(MirrorLobeTest, SharpLobesKeepTheDigitsThatTheDotProductLoses) {
  constexpr double exponent = 1e7;
  double worst = 0;
  double worst_naive = 0;
  for (int i = 0; i < 1000; ++i) {
    const DirectionPair<double> pair{brdf::direction_from_degrees(30, 20),
                                     brdf::direction_from_degrees(30 + 5e-5 * i, 200)};
    const Digits truth = pow(mirror_cosine_in_digits(pair), Digits(exponent));
    const auto& [wi, wo] = pair;
    const double dot = wi.z * wo.z - wi.x * wo.x - wi.y * wo.y;
    worst = std::max(worst, error(lobe(pair, exponent), truth));
    worst_naive = std::max(worst_naive, error(std::pow(dot, exponent), truth));
  }
  EXPECT_LE(worst, 4 * std::numeric_limits<double>::epsilon());
  EXPECT_GT(worst_naive, 1e-10);
}

TEST(MirrorLobeTest, AgreesWithFiftyDigitsEverywhere) {
  DirectionPairs<double> draws(8, 1e-5);
  for (int i = 0; i < 4000; ++i) {
    const auto pair = draws.next();
    const double exponent = std::expm1(draws.uniform(0, std::log(1e6)));
    const Digits cosine = mirror_cosine_in_digits(pair);
    if (cosine <= 1e-15) continue;  // 0, or of any sign within the rounding
    const Digits truth = pow(cosine, Digits(exponent));
    // Exponents below 1 make the most of a small cosine: n C^n (epsilon / C).
    const double bound = 10 * std::max(1.0, (exponent * truth / cosine).convert_to<double>());
    EXPECT_LE(error(lobe(pair, exponent), truth), bound * std::numeric_limits<double>::epsilon())
        << "exponent " << exponent << ", cosine " << cosine;
  }
}

TEST(MirrorLobeTest, IsZeroWhereTheCosineIsNotPositive) {
  const Direction<double> wi = brdf::direction_from_degrees(60, 0);
  for (const double exponent : {0.0, 1.0, 1e16}) {
    EXPECT_EQ(lobe({wi, brdf::direction_from_degrees(60, 0)}, exponent), 0) << exponent;
    EXPECT_EQ(lobe({{1, 0, 0}, {0, 1, 0}}, exponent), 0) << exponent;
  }
}

TEST(MirrorLobeTest, IsOneInTheMirrorDirectionWhateverTheExponent) {
  DirectionPairs<double> draws(9, 1e-300);
  for (int i = 0; i < 1000; ++i) {
    const Direction<double> wi = draws.next().wi;
    for (const double exponent : {0.0, 1.0, 1e6, 1e300}) {
      EXPECT_EQ(lobe({wi, {-wi.x, -wi.y, wi.z}}, exponent), 1);
    }
  }
}

TEST(MirrorLobeTest, ExponentZeroIsTheHalfSpace) {
  const Direction<double> wi = brdf::direction_from_degrees(60, 0);
  EXPECT_EQ(lobe({wi, brdf::direction_from_degrees(29, 0)}, 0), 1);
  EXPECT_EQ(lobe({wi, brdf::direction_from_degrees(31, 0)}, 0), 0);
}

TEST(MirrorLobeTest, DerivativesByTheExponentAreFinite) {
  using Jet = ceres::Jet<double, 1>;
  DirectionPairs<double> draws(10, std::numeric_limits<double>::denorm_min());
  for (int i = 0; i < 20000; ++i) {
    const auto [wi, wo] = draws.next();
    for (const double exponent : {0.0, 1.0, 1e6, 1e16}) {
      const Jet value = brdf::power(brdf::mirror_cosine(wi, wo), Jet(exponent, 0));
      ASSERT_TRUE(std::isfinite(value.a) && std::isfinite(value.v[0])) << value;
    }
  }
}

}  // namespace
}  // namespace gonio::tests
