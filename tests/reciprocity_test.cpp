// Helmholtz reciprocity: exchanging wi and wo changes nothing, for every term that says so; and a
// term that says it is not reciprocal is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/every_term.h"
#include "tests/extreme_directions.h"

namespace gonio::tests {
namespace {

/// |a - b| as a share of the larger.
double difference(double a, double b) {
  const double largest = std::max(std::abs(a), std::abs(b));
  return largest > 0 ? std::abs(a - b) / largest : 0;
}

struct Exchange {
  double worst = 0;  // difference of a basis function
  int bright = 0;    // draws in which some basis function is not 0
};

/// Over random shapes within the bounds and pairs of directions, half of them extreme.
template <class T>
Exchange exchange(int draws) {
  ShapeDraws shapes(5);
  DirectionPairs<double> pairs(3, 1e-6);
  Exchange result;
  for (int i = 0; i < draws; ++i) {
    const auto shape = shapes.draw<T>();
    const auto [wi, wo] = pairs.next();
    const auto there = T::template basis<double, double>(shape, wi, wo);
    const auto back = T::template basis<double, double>(shape, wo, wi);
    bool is_bright = false;
    for (std::size_t b = 0; b < there.size(); ++b) {
      // Values below may be denormal, with fewer digits.
      if (std::max(there[b], back[b]) < 1e-290) continue;
      is_bright = true;
      result.worst = std::max(result.worst, difference(there[b], back[b]));
    }
    result.bright += is_bright;
  }
  return result;
}

template <class T>
class Reciprocity : public testing::Test {};
TYPED_TEST_SUITE(Reciprocity, EveryTerm, TermNames);

TYPED_TEST(Reciprocity, IsAsTheTermSays) {
  const Exchange result = exchange<TypeParam>(2000);
  EXPECT_GT(result.bright, 500) << "the draws miss the lobe";
  if (TypeParam::description.reciprocal) {
    EXPECT_LE(result.worst, 1e-13);
  } else {
    EXPECT_GT(result.worst, 0.01);
  }
}

/// Neither reciprocal nor honest.
struct TiltedLambert : brdf::Lambert {
  template <class S, class D>
  static std::array<S, 1> basis(const std::array<S, 0>& /*shape*/, const brdf::Direction<D>& wi,
                                const brdf::Direction<D>& wo) {
    return {S(wi.z + (1 + 1e-12) * wo.z)};
  }
};

TEST(ReciprocityCheck, SeesADifferenceOfAFewThousandRoundings) {
  EXPECT_GT(exchange<TiltedLambert>(200).worst, 1e-13);
}

}  // namespace
}  // namespace gonio::tests
