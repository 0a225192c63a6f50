// Ashikhmin and Shirley's model where numbers run out of range: finite, not negative, and right as
// far as the type can say; and its derivatives by Jets.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "brdf/ashikhmin_shirley.h"
#include "tests/ashikhmin_shirley_reference.h"
#include "tests/extreme_directions.h"

namespace gonio::tests {
namespace {

using Coupled = brdf::CoupledAshikhminShirley<brdf::AnisotropicExponents>;
using CoupledIsotropic = brdf::CoupledAshikhminShirley<brdf::IsotropicExponent>;

/// Both ends of the exponents, the smallest numbers, and some between.
template <class D>
D some_exponent(DirectionPairs<D>& pairs) {
  const D choices[] = {0, std::numeric_limits<D>::denorm_min(), pairs.uniform(0, 1),
                       std::pow(D(10), pairs.uniform(0, 6)), D(1e6)};
  return choices[static_cast<std::size_t>(pairs.uniform(0, D(4.99)))];
}

template <class D>
void expect_sane() {
  DirectionPairs<D> pairs(3, std::numeric_limits<D>::denorm_min());
  for (int i = 0; i < 200'000; ++i) {
    const DirectionPair<D> pair = pairs.next();
    const D nu = some_exponent(pairs);
    const D nv = some_exponent(pairs);
    for (const D value : Coupled::basis<D, D>({nu, nv}, pair.wi, pair.wo)) {
      ASSERT_TRUE(std::isfinite(value) && value >= 0)
          << value << " at cosines " << pair.wi.z << ", " << pair.wo.z << ", " << nu << ", " << nv;
    }
    for (const D value : CoupledIsotropic::basis<D, D>({nu}, pair.wi, pair.wo)) {
      ASSERT_TRUE(std::isfinite(value) && value >= 0)
          << value << " at cosines " << pair.wi.z << ", " << pair.wo.z << ", " << nu;
    }
  }
}

TEST(AshikhminShirleyExtremes, DoubleIsFiniteAndNotNegative) { expect_sane<double>(); }
TEST(AshikhminShirleyExtremes, FloatIsFiniteAndNotNegative) { expect_sane<float>(); }

/// The specular part for Rs = 1: the value that the type can hold, saturated.
template <class D>
void expect_right() {
  constexpr D largest = std::numeric_limits<D>::max();
  DirectionPairs<D> pairs(4, std::numeric_limits<D>::min());
  int compared = 0;
  for (int i = 0; i < 10'000; ++i) {
    const DirectionPair<D> pair = pairs.next();
    const D nu = some_exponent(pairs);
    const D nv = some_exponent(pairs);
    const auto truth = ashikhmin_shirley_reference(exact(nu), exact(nv), pair.wi, pair.wo);
    if (truth.decay > 27) continue;  // dark: less than 1e-12 of the peak
    // Between opposite directions the half vector's length is in part the difference of the norms,
    // two roundings, which adds to it in squares; h.wi of unit vectors is known no better.
    const Digits length = reference_half_vector(pair.wi, pair.wo).length;
    const Digits of_norms = 2 * std::numeric_limits<D>::epsilon() / length;
    if (of_norms > 0.1) continue;
    const auto basis = Coupled::basis<D, D>({nu, nv}, pair.wi, pair.wo);
    const Digits expected = truth.specular < largest ? truth.specular : Digits(largest);
    // Near the largest number the denominator is denormal and has 13 bits.
    const Digits tolerance =
        of_norms * of_norms +
        (truth.specular > largest / 1e5 ? 1e-3 : 200 * double{std::numeric_limits<D>::epsilon()});
    ASSERT_LE(abs(exact(basis[1]) + exact(basis[2]) - expected), tolerance * expected)
        << basis[1] << " + " << basis[2] << " instead of " << expected.template convert_to<double>()
        << " at cosines " << pair.wi.z << ", " << pair.wo.z << ", " << nu << ", " << nv;
    ++compared;
  }
  EXPECT_GT(compared, 3000);
}

TEST(AshikhminShirleyExtremes, DoubleIsRightOrSaturated) { expect_right<double>(); }
TEST(AshikhminShirleyExtremes, FloatIsRightOrSaturated) { expect_right<float>(); }

// d ln S / d nu = 1 / (2 (nu + 1)) - cos^2(phi) (-ln n.h), and so for nv with the sine.
TEST(AshikhminShirleyExtremes, JetDerivativesAgreeWithTheClosedForm) {
  using Jet = ceres::Jet<double, 2>;
  DirectionPairs<double> pairs(5, 1e-3);
  int compared = 0;
  for (int i = 0; i < 20'000; ++i) {
    const DirectionPair<double> pair = pairs.next();
    const double nu = some_exponent(pairs);
    const double nv = some_exponent(pairs);
    const auto truth = ashikhmin_shirley_reference(nu, nv, pair.wi, pair.wo);
    const auto basis = Coupled::basis<Jet, double>({Jet(nu, 0), Jet(nv, 1)}, pair.wi, pair.wo);
    for (const Jet& jet : basis) {
      ASSERT_TRUE(std::isfinite(jet.v[0]) && std::isfinite(jet.v[1])) << nu << ", " << nv;
    }
    if (truth.decay > 27) continue;
    const ReferenceHalfVector h = reference_half_vector(pair.wi, pair.wo);
    const Digits log_cosine = log(Digits(h.z / h.length));
    const Digits across = h.x * h.x + h.y * h.y;
    const Digits x = across == 0 ? Digits(0) : Digits(h.x * h.x / across * log_cosine);
    const Digits y = across == 0 ? Digits(0) : Digits(h.y * h.y / across * log_cosine);
    const Digits value = truth.specular * (1 - truth.darkness);
    // The two parts of a derivative may cancel: their sizes are its scale.
    const Digits by_nu = 1 / (2 * (Digits(nu) + 1));
    const Digits by_nv = 1 / (2 * (Digits(nv) + 1));
    EXPECT_LE(abs(exact(basis[1].v[0]) - value * (by_nu + x)), 1e-13 * value * (by_nu - x));
    EXPECT_LE(abs(exact(basis[1].v[1]) - value * (by_nv + y)), 1e-13 * value * (by_nv - y));
    EXPECT_EQ(basis[0].v[0], 0);
    EXPECT_EQ(basis[0].v[1], 0);
    ++compared;
  }
  EXPECT_GT(compared, 5000);
}

}  // namespace
}  // namespace gonio::tests
