// The derivatives of every term by every shape parameter and amplitude, inside the domain and at
// its edges.
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <concepts>

#include "brdf/phong.h"
#include "brdf/ward.h"
#include "tests/derivative_check.h"
#include "tests/directions.h"
#include "tests/every_term.h"
#include "tests/extreme_directions.h"

namespace gonio::tests {
namespace {

template <class T>
class Derivatives : public testing::Test {
 protected:
  /// Checks pairs of directions, half of them at extremes, with parameter `edge` at `place`.
  void check(int draws, std::size_t edge, Place place) {
    ShapeDraws shapes(7);
    DirectionPairs<double> pairs(11, 1e-5);
    for (int i = 0; i < draws && !this->HasFailure(); ++i) {
      const auto shape = shapes.draw<T>(edge, place);
      const auto [wi, wo] = pairs.next();
      add(expect_derivatives_match<T>(shape, wi, wo));
    }
  }

  /// Directions whose half vector is within a few widths of a lobe with 1e-5..1 for a width.
  void check_lobes(int draws, std::size_t edge, Place place) {
    ShapeDraws shapes(13);
    DirectionPairs<double> pairs(17, 1e-3);
    for (int i = 0; i < draws && !this->HasFailure(); ++i) {
      const auto shape = shapes.draw<T>(edge, place);
      const brdf::Direction<double> wi = pairs.next().wi;
      const double size = std::pow(10, pairs.uniform(-5, 0));
      const double phi = pairs.uniform(-4, 4);
      const auto wo = mirrored_about_slopes(wi, size * std::cos(phi), size * std::sin(phi));
      if (wo.z > 0) add(expect_derivatives_match<T>(shape, wi, wo));
    }
  }

  void add(const std::array<ComparedDerivatives, T::shape.size()>& more) {
    for (std::size_t j = 0; j < more.size(); ++j) {
      sums[j].compared += more[j].compared;
      sums[j].told += more[j].told;
    }
  }

  std::array<ComparedDerivatives, T::shape.size()> sums{};
};
TYPED_TEST_SUITE(Derivatives, EveryTerm, TermNames);

TYPED_TEST(Derivatives, ByTheShapeAreThoseOfDifferencesInFiftyDigits) {
  constexpr std::size_t no_edge = TypeParam::shape.size();
  this->check(400, no_edge, Place::inside);
  this->check_lobes(400, no_edge, Place::inside);
  for (std::size_t j = 0; j < no_edge; ++j) {
    EXPECT_GT(this->sums[j].told, 200) << TypeParam::shape[j].name << ": the draws miss the lobe";
  }
}

TYPED_TEST(Derivatives, ByTheShapeAreRightAtItsEdges) {
  for (std::size_t j = 0; j < TypeParam::shape.size(); ++j) {
    for (const Place place : {Place::lower, Place::near_lower, Place::near_upper, Place::upper}) {
      SCOPED_TRACE(testing::Message() << TypeParam::shape[j].name << " at edge " << int(place));
      this->sums = {};
      this->check(60, j, place);
      this->check_lobes(60, j, place);
      // Few draws see a lobe of alpha = 1e-4.
      EXPECT_GT(this->sums[j].compared, 5);
    }
  }
}

TYPED_TEST(Derivatives, ByTheAmplitudesAreThoseOfDifferencesInFiftyDigits) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 50; ++i) {
    std::array<double, TypeParam::amplitudes.size()> amplitudes{};
    for (double& amplitude : amplitudes) amplitude = i == 0 ? 0 : i == 1 ? 1 : uniform(generator);
    expect_coefficient_derivatives_match<TypeParam>(amplitudes);
  }
}

// The assertion itself --------------------------------------------------------------------------

/// T with derivatives that are wrong by the given factor, in Jets only.
template <class T, int Millionths>
struct WrongDerivative : T {
  template <class S, class D>
  static auto basis(const std::array<S, T::shape.size()>& shape, const brdf::Direction<D>& wi,
                    const brdf::Direction<D>& wo) {
    auto result = T::template basis<S, D>(shape, wi, wo);
    if constexpr (!std::same_as<S, D>) {
      for (S& value : result) value.v *= 1 + 1e-6 * Millionths;
    }
    return result;
  }
};

using brdf::direction_from_degrees;

TEST(DerivativeCheck, FindsADerivativeThatIsWrongByAMillionth) {
  using Wrong = WrongDerivative<brdf::IsotropicWard<brdf::WardLobe>, 1>;
  using Right = WrongDerivative<brdf::IsotropicWard<brdf::WardLobe>, 0>;
  expect_derivatives_match<Right>({0.1}, direction_from_degrees(40, 0),
                                  direction_from_degrees(45, 180));
  EXPECT_NONFATAL_FAILURE(expect_derivatives_match<Wrong>({0.1}, direction_from_degrees(40, 0),
                                                          direction_from_degrees(45, 180)),
                          "derivative of ward, basis function 0, by alpha");
}

TEST(DerivativeCheck, FindsADerivativeThatIsWrongAtABound) {
  using Wrong = WrongDerivative<brdf::Phong, 1>;
  EXPECT_NONFATAL_FAILURE(expect_derivatives_match<Wrong>({0}, direction_from_degrees(40, 0),
                                                          direction_from_degrees(70, 150)),
                          "by exponent");
}

/// A term whose derivative by its second parameter is forgotten.
struct ForgottenDerivative : brdf::AnisotropicWard<brdf::WardGmdLobe> {
  template <class S, class D>
  static std::array<S, 1> basis(const std::array<S, 2>& alpha, const brdf::Direction<D>& wi,
                                const brdf::Direction<D>& wo) {
    using Ward = brdf::AnisotropicWard<brdf::WardGmdLobe>;
    if constexpr (std::same_as<S, D>) {
      return Ward::basis<S, D>(alpha, wi, wo);
    } else {
      return Ward::basis<S, D>({alpha[0], S(alpha[1].a)}, wi, wo);
    }
  }
};

TEST(DerivativeCheck, FindsADerivativeThatIsForgotten) {
  EXPECT_NONFATAL_FAILURE(
      expect_derivatives_match<ForgottenDerivative>({0.2, 0.1}, direction_from_degrees(40, 0),
                                                    direction_from_degrees(45, 170)),
      "by alpha_y is");
}

/// sqrt(10 - alpha): at the upper bound its derivative is infinite.
struct NotFinite : brdf::IsotropicWard<brdf::WardLobe> {
  template <class S, class D>
  static std::array<S, 1> basis(const std::array<S, 1>& alpha, const brdf::Direction<D>& /*wi*/,
                                const brdf::Direction<D>& /*wo*/) {
    using std::sqrt;
    return {sqrt(S(D(10)) - alpha[0])};
  }
};

TEST(DerivativeCheck, FindsADerivativeThatIsNotFinite) {
  EXPECT_NONFATAL_FAILURE(expect_derivatives_match<NotFinite>({10}, direction_from_degrees(40, 0),
                                                              direction_from_degrees(45, 170)),
                          "not finite");
}

}  // namespace
}  // namespace gonio::tests
