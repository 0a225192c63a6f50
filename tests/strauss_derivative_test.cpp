// Strauss's derivatives by s, m and t, as the solver takes them: against differences in 50 digits,
// and finite at every extreme.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "brdf/strauss.h"
#include "tests/extreme_directions.h"
#include "tests/strauss_reference.h"

namespace gonio::tests {
namespace {

using Jet = ceres::Jet<double, 3>;

template <class T>
class StraussDerivativeTest : public testing::Test {};
using Terms = testing::Types<brdf::Strauss, brdf::StraussListing>;
TYPED_TEST_SUITE(StraussDerivativeTest, Terms);

template <class T>
std::array<Jet, 2> jets(double s, double m, double t, const DirectionPair<double>& pair) {
  return T::template basis<Jet, double>({Jet(s, 0), Jet(m, 1), Jet(t, 2)}, pair.wi, pair.wo);
}

// R = min(1, ..) has a kink, so the draws keep away from it: r + j (r + 0.1) < 1 for t > 0.3, as
// then r < 0.7 and j, seldom more than 0.1 where neither direction grazes, is at most 0.3.
TYPED_TEST(StraussDerivativeTest, AgreeWithFiftyDigitDifferences) {
  const Digits step("1e-15");  // truncation 1e-30 times the third derivative, 50 digits to cancel
  DirectionPairs<double> draws(3, 0.05);
  for (int i = 0; i < 1000; ++i) {
    const auto pair = draws.next();
    const double shape[] = {draws.uniform(0.01, 0.99), draws.uniform(0.01, 0.99),
                            draws.uniform(0.3, 0.99)};
    const auto angles =
        strauss_angles<Digits>(std::is_same_v<TypeParam, brdf::StraussListing>, pair.wi, pair.wo);
    const auto truth = [&](int changed, const Digits& change) {
      Digits p[] = {shape[0], shape[1], shape[2]};
      p[changed] += change;
      return reference_strauss(Digits(1), {p[0], p[1], p[2]}, angles);
    };
    const auto basis = jets<TypeParam>(shape[0], shape[1], shape[2], pair);
    const Jet value = basis[0] + basis[1];
    for (int k = 0; k < 3; ++k) {
      const Digits expected = (truth(k, step) - truth(k, -step)) / (2 * step);
      // Of the value's scale: the diffuse and the specular share may change in opposite senses.
      const Digits scale = value.a / (1 - shape[k]) + abs(expected);
      EXPECT_LE(abs(value.v[k] - expected), 1e-11 * scale + 1e-20)
          << "by parameter " << k << " at " << shape[0] << ", " << shape[1] << ", " << shape[2];
    }
  }
}

/// 0, 1 and what is next to them.
constexpr double edges[] = {0, 1e-300, 1e-7, 0.5, 1 - 1e-7, 1 - 0x1p-53, 1};

TYPED_TEST(StraussDerivativeTest, AreFiniteAtEveryExtreme) {
  DirectionPairs<double> draws(5, std::numeric_limits<double>::denorm_min());
  for (int i = 0; i < 1000; ++i) {
    const auto pair = draws.next();
    for (const double s : edges) {
      for (const double m : edges) {
        for (const double t : edges) {
          for (const Jet& value : jets<TypeParam>(s, m, t, pair)) {
            ASSERT_TRUE(std::isfinite(value.a) && value.v.allFinite())
                << value << " at " << s << ", " << m << ", " << t << ", cosines " << pair.wi.z
                << ", " << pair.wo.z;
          }
        }
      }
    }
  }
}

// The lobe's derivative by s is taken as its limit at s = 1, which is 0; what is left is that of
// d Rd and R: with m = t = 0 and j = 0, -3 and 3.
TYPED_TEST(StraussDerivativeTest, TheMirrorsLobeDoesNotChange) {
  const brdf::Direction<double> pole{0, 0, 1};
  const auto basis = jets<TypeParam>(1, 0, 0, {pole, pole});
  EXPECT_NEAR(basis[0].v[0], -3 / std::numbers::pi, 1e-15);
  EXPECT_NEAR(basis[1].v[0], 3 / std::numbers::pi, 1e-15);
}

}  // namespace
}  // namespace gonio::tests
