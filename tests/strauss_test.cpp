// Strauss's model, with either argument, against 50-digit textbook formulas and closed forms.
#include "brdf/strauss.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/directions.h"
#include "tests/extreme_directions.h"
#include "tests/strauss_reference.h"

namespace gonio::tests {
namespace {

using brdf::Direction;
using brdf::Strauss;
using brdf::StraussListing;

static_assert(brdf::Term<Strauss> && brdf::Term<StraussListing>);

constexpr double smallest_cosine = 1.7e-5;  // 89.999 deg

template <class D>
using Shape = std::array<D, 3>;

/// One of s, m, t: over 0..1, with a share at 0 and 1 and within 1e-7 of them.
template <class D>
D drawn_share(DirectionPairs<D>& draws) {
  const D at = draws.uniform(0, 1);
  const D near = draws.uniform(0, D(1e-7));
  if (at < D(0.1)) return 0;
  if (at < D(0.2)) return near;
  if (at < D(0.3)) return 1;
  if (at < D(0.4)) return 1 - near;
  return draws.uniform(0, 1);
}

template <class D>
Shape<D> drawn_shape(DirectionPairs<D>& draws) {
  const D s = drawn_share(draws);
  const D m = drawn_share(draws);
  return {s, m, drawn_share(draws)};
}

template <class T>
constexpr bool is_listing = std::is_same_v<T, StraussListing>;

/// f_r for the colour c, added in many digits so that the sum adds no rounding of its own.
template <class T, class N = Digits, class D>
N value_of(double c, const Shape<D>& shape, const DirectionPair<D>& pair) {
  const auto basis = T::template basis<D, D>(shape, pair.wi, pair.wo);
  return c * exact_in<N>(basis[0]) + exact_in<N>(basis[1]);
}

template <class N, class D>
StraussParameters<N> parameters(const Shape<D>& shape) {
  return {exact_in<N>(shape[0]), exact_in<N>(shape[1]), exact_in<N>(shape[2])};
}

template <class T, class N, class D>
N truth_of(double c, const Shape<D>& shape, const DirectionPair<D>& pair) {
  return reference_strauss(N(c), parameters<N>(shape),
                           strauss_angles<N>(is_listing<T>, pair.wi, pair.wo));
}

/// The peak of f_r cos_i for this shape and c = 1: in the mirror direction, at this incidence or
/// at 60 deg, where both arguments have much of their Fresnel term.
template <class T, class D>
Digits peak_of(const Shape<D>& shape, const Direction<D>& wi) {
  const auto at = [&](const Direction<D>& w) {
    auto angles = strauss_angles<Digits>(is_listing<T>, w, w);
    angles.mirror_cosine = 1;
    return Digits(reference_strauss(Digits(1), parameters<Digits>(shape), angles) * angles.cos_i);
  };
  const Digits here = at(wi);
  const Digits there = at(as<D>(brdf::direction_from_degrees(60, 0)));
  return here > there ? here : there;
}

template <class T>
class StraussTest : public testing::Test {};
using Terms = testing::Types<Strauss, StraussListing>;
TYPED_TEST_SUITE(StraussTest, Terms);

// Where the mirror cosine C is small its rounding, at most 2 epsilon, is 2 epsilon / C of it and
// 3/(1-s) times that of the lobe; C^(3/(1-s)) >= 1e-12 keeps that below 1e-11. 40 roundings for the
// rest, of which the lobe's exponent, up to 27.6, makes the most.
TYPED_TEST(StraussTest, DoubleAgreesWithFiftyDigits) {
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  DirectionPairs<double> draws(1990, smallest_cosine);
  int compared = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto pair = draws.next();
    const Shape<double> shape = drawn_shape(draws);
    if (shape[0] == 1) continue;  // has its own test: no rounding of a direction is small there
    const Digits least = peak_of<TypeParam>(shape, pair.wi) * 1e-12 / exact(pair.wi.z);
    for (const double c : {0.0, 0.3, 1.0}) {
      const Digits truth = truth_of<TypeParam, Digits>(c, shape, pair);
      const Digits off = abs(value_of<TypeParam>(c, shape, pair) - truth);
      if (truth <= least) {
        EXPECT_LE(off, least) << "as dark as it should be";
        continue;
      }
      const Digits cosine = strauss_angles<Digits>(false, pair.wi, pair.wo).mirror_cosine;
      const Digits of_cosine = cosine > 0 ? 2 * 3 / (1 - exact(shape[0])) / cosine : Digits(0);
      const Digits bound = rounding * (40 + (cosine < 0.5 ? of_cosine : Digits(0)));
      EXPECT_LE(off, bound * truth)
          << "s, m, t = " << shape[0] << ", " << shape[1] << ", " << shape[2] << ", cosines "
          << pair.wi.z << ", " << pair.wo.z << ", mirror " << cosine;
      EXPECT_LE(off, 1e-11 * truth);
      ++compared;
    }
  }
  EXPECT_GT(compared, 5000);
}

/// The largest error of f_r cos_i as a fraction of its peak, for exponents up to 1e4.
template <class T, class F>
double worst_float_error(const F& value_of_float) {
  DirectionPairs<float> draws(1990, static_cast<float>(smallest_cosine));
  double worst = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto pair = draws.next();
    Shape<float> shape = drawn_shape(draws);
    shape[0] = std::min(shape[0], 1 - 3e-4F);
    const Digits peak = peak_of<T>(shape, pair.wi);
    if (peak == 0) continue;
    for (const double c : {0.0, 1.0}) {
      const Digits truth = truth_of<T, Digits>(c, shape, pair);
      const Digits off = (value_of_float(c, shape, pair) - truth) * exact(pair.wi.z) / peak;
      worst = std::max(worst, abs(off).template convert_to<double>());
    }
  }
  return worst;
}

TYPED_TEST(StraussTest, FloatAgreesWithFiftyDigits) {
  const auto value = [](double c, const Shape<float>& shape, const DirectionPair<float>& pair) {
    return value_of<TypeParam>(c, shape, pair);
  };
  EXPECT_LE(worst_float_error<TypeParam>(value), 2e-6);
}

/// The formula as it is printed, in float: acos of the cosine, pow of the mirror cosine, (1-t)-Rd.
template <class T>
Digits as_printed(double c, const Shape<float>& shape, const DirectionPair<float>& pair) {
  const auto& [wi, wo] = pair;
  const auto x = [](float cosine) {
    return is_listing<T> ? cosine : std::acos(cosine) / (std::numbers::pi_v<float> / 2);
  };
  const StraussAngles<float> angles{x(wi.z), x(wo.z), wi.z,
                                    wi.z * wo.z - wi.x * wo.x - wi.y * wo.y};
  return exact(reference_strauss(static_cast<float>(c), {shape[0], shape[1], shape[2]}, angles));
}

// The mirror cosine moves in steps of 6e-8, which an exponent of 1e4 makes 6e-4 of the lobe.
TYPED_TEST(StraussTest, ThePrintedFormulaLosesDigitsInFloat) {
  EXPECT_GT(worst_float_error<TypeParam>(as_printed<TypeParam>), 3e-4);
}

// Down to the smallest normal cosine: beyond it 1/cos saturates.
TYPED_TEST(StraussTest, IsRightOrSaturatedAtTheSmallestCosines) {
  const auto largest = exact_in<ManyDigits>(std::numeric_limits<double>::max());
  DirectionPairs<double> draws(300, 1e-300);
  for (int i = 0; i < 100; ++i) {
    const auto pair = draws.next();
    const Shape<double> shape{draws.uniform(0, 0.9), draws.uniform(0, 1), draws.uniform(0, 1)};
    const auto truth = truth_of<TypeParam, ManyDigits>(0.5, shape, pair);
    const ManyDigits expected = truth < largest ? truth : largest;
    const auto value = value_of<TypeParam, ManyDigits>(0.5, shape, pair);
    EXPECT_LE(abs(ManyDigits(value - expected)), 1e-11 * expected)
        << "cosines " << pair.wi.z << ", " << pair.wo.z;
  }
}

template <class T, class D>
void expect_finite_and_not_negative() {
  DirectionPairs<D> draws(33, std::numeric_limits<D>::denorm_min());
  for (int i = 0; i < 200000; ++i) {
    const auto [wi, wo] = draws.next();
    const Shape<D> shape = drawn_shape(draws);
    for (const D value : T::template basis<D, D>(shape, wi, wo)) {
      ASSERT_TRUE(std::isfinite(value) && value >= 0)
          << value << " at s, m, t = " << shape[0] << ", " << shape[1] << ", " << shape[2]
          << ", cosines " << wi.z << ", " << wo.z;
    }
  }
}

TYPED_TEST(StraussTest, IsFiniteAndNotNegativeInDouble) {
  expect_finite_and_not_negative<TypeParam, double>();
}
TYPED_TEST(StraussTest, IsFiniteAndNotNegativeInFloat) {
  expect_finite_and_not_negative<TypeParam, float>();
}

TYPED_TEST(StraussTest, IsExactlyZeroBelowTheHorizonAndOnIt) {
  const Direction<double> above = brdf::direction_from_degrees(30, 40);
  const std::array<double, 2> nothing{0, 0};
  for (const double z : {0.0, -0.0, -1e-300, -0.5}) {
    const Direction<double> below{std::sqrt(1 - z * z), 0, z};
    EXPECT_EQ((TypeParam::template basis<double, double>({0.5, 0.5, 0}, below, above)), nothing);
    EXPECT_EQ((TypeParam::template basis<double, double>({0.5, 0.5, 0}, above, below)), nothing);
  }
}

// A perfect mirror, s = 1, has no diffuse light: d Rd = 0. With m = t = 0 its r = 1 and so R = 1:
// f_r cos_i is 1/pi in the mirror direction.
TYPED_TEST(StraussTest, APerfectMirrorReflectsInTheMirrorDirectionOnly) {
  const Direction<double> wi = brdf::direction_from_degrees(40, 20);
  const Direction<double> mirrored{-wi.x, -wi.y, wi.z};
  const auto at = [&](const Direction<double>& wo) {
    return TypeParam::template basis<double, double>({1, 0, 0}, wi, wo);
  };
  EXPECT_EQ(at(mirrored)[0], 0);
  EXPECT_DOUBLE_EQ(at(mirrored)[1], 1 / (std::numbers::pi * wi.z));
  for (const double off : {1e-12, 1e-3, 30.0, 90.0}) {
    const Direction<double> wo = brdf::direction_from_degrees(40 + (off < 50 ? off : -off), 200);
    EXPECT_EQ(at(wo), (std::array<double, 2>{0, 0})) << off;
  }
}

TYPED_TEST(StraussTest, TheLastSmoothnessBelowTheMirrorHasItsPeak) {
  const Direction<double> wi = brdf::direction_from_degrees(40, 20);
  const double s = std::nextafter(1.0, 0.0);  // an exponent of 2.7e16
  const auto value = TypeParam::template basis<double, double>({s, 0, 0}, wi, {-wi.x, -wi.y, wi.z});
  EXPECT_DOUBLE_EQ(value[1], 1 / (std::numbers::pi * wi.z));
}

// At normal incidence j = 0: F(0) = 0 with the angle, G(1) = 0 with the cosine. So R = r, and
// Cs = 1 + m (c - 1) with the angle, 1 with the cosine.
TYPED_TEST(StraussTest, HasItsClosedFormAtNormalIncidence) {
  constexpr double s = 0.6;
  constexpr double m = 0.3;
  constexpr double t = 0.2;
  const Direction<double> pole{0, 0, 1};
  const auto value = TypeParam::template basis<double, double>({s, m, t}, pole, pole);
  const double r = s * s * s * (1 - t);
  const double diffuse = (1 - m * s) * (1 - s * s * s) * (1 - t);
  const double tint = is_listing<TypeParam> ? 0 : m;
  EXPECT_NEAR(value[0], (diffuse + r * tint) / std::numbers::pi, 1e-15);
  EXPECT_NEAR(value[1], r * (1 - tint) / std::numbers::pi, 1e-15);
}

// A black plastic's highlight between 20 and 80 deg: the lobe is the same both ways, but f_r is
// divided by the incident cosine, and R knows the Fresnel reflection of the incident light alone:
// the larger at 80 deg with the angle, the larger at 20 deg with the cosine.
TYPED_TEST(StraussTest, IsNotReciprocal) {
  EXPECT_FALSE(TypeParam::description.reciprocal);
  const Shape<double> shape{0.5, 0, 0};
  const DirectionPair<double> forth{brdf::direction_from_degrees(20, 0),
                                    brdf::direction_from_degrees(80, 180)};
  const DirectionPair<double> back{forth.wo, forth.wi};
  const Digits ratio = value_of<TypeParam>(0, shape, back) / value_of<TypeParam>(0, shape, forth);
  const double of_cosines = forth.wi.z / back.wi.z;  // 5.4
  if (is_listing<TypeParam>) {
    EXPECT_GT(ratio, 2);
    EXPECT_LT(ratio, of_cosines);
  } else {
    EXPECT_GT(ratio, of_cosines);
  }
}

TYPED_TEST(StraussTest, IsAffineInTheColour) {
  EXPECT_EQ(TypeParam::template coefficients<double>({0.4}), (std::array<double, 2>{0.4, 1}));
  EXPECT_EQ(TypeParam::description.coefficients, brdf::Coefficients::affine);
  EXPECT_EQ(TypeParam::description.kind, brdf::TermKind::whole);
}

TEST(StraussFunctionTest, FresnelAndAttenuationHaveTheirEnds) {
  const auto argument = [](double x) {
    return brdf::strauss_detail::Argument<double>{x, 1 - x, 0, 0};
  };
  const auto fresnel = [&](double x) {
    return brdf::strauss_detail::fresnel(argument(x)).per_x * x;
  };
  const auto attenuation = [&](double x) { return brdf::strauss_detail::attenuation(argument(x)); };
  EXPECT_EQ(fresnel(0), 0);
  EXPECT_DOUBLE_EQ(fresnel(1), 1);
  EXPECT_DOUBLE_EQ(attenuation(0), 1);
  EXPECT_EQ(attenuation(1), 0);
}

// The angle of a float cosine of 1 - 6e-8, where acos moves in steps, and of 1e-6 deg in double.
TEST(StraussFunctionTest, TheAngleKeepsItsDigitsAtThePole) {
  const double theta = 1e-6 * std::numbers::pi / 180;
  const Direction<double> w = brdf::direction_from_radians(theta, 1);
  EXPECT_NEAR(brdf::StraussAngle::argument(w).x / (1e-6 / 90), 1, 1e-15);
  EXPECT_GT(std::abs(std::acos(w.z) / theta - 1), 0.1) << "the cosine does not hold it";
}

}  // namespace
}  // namespace gonio::tests
