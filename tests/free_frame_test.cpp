// Terms whose tangent is turned by psi: against turned azimuths, by their symmetries, and their
// derivatives against differences in 50 digits.
#include "brdf/free_frame.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <tuple>
#include <type_traits>
#include <utility>

#include "brdf/model.h"
#include "brdf/terms.h"
#include "tests/ward_reference.h"

namespace gonio::brdf {
namespace {

using std::numbers::pi;
using tests::Digits;

/// A pair of directions by their angles in radians, and a shape. Roughness is log-uniform over
/// 0.05..1; the half vector of every other pair is near the normal, within most lobes.
struct Draw {
  double theta_i, phi_i, theta_o, phi_o;
  double alpha_x, alpha_y, psi;

  /// The directions with all azimuths greater by `turn`.
  Direction<double> wi(double turn = 0) const {
    return direction_from_radians(theta_i, phi_i + turn);
  }
  Direction<double> wo(double turn = 0) const {
    return direction_from_radians(theta_o, phi_o + turn);
  }
};

class Draws {
 public:
  Draw next() {
    Draw d{};
    d.theta_i = uniform(0, 80 * pi / 180);
    d.phi_i = uniform(-pi, pi);
    d.theta_o = uniform(0, 80 * pi / 180);
    d.phi_o = uniform(-pi, pi);
    if (count_++ % 2 == 0) {
      d.theta_o = std::min(d.theta_i + uniform(0, 0.2), 80 * pi / 180);
      d.phi_o = d.phi_i + pi + uniform(-0.2, 0.2);
    }
    d.alpha_x = std::pow(10, uniform(-1.3, 0));
    d.alpha_y = std::pow(10, uniform(-1.3, 0));
    d.psi = uniform(-pi / 2, pi / 2);
    return d;
  }

 private:
  double uniform(double lowest, double highest) {
    return std::uniform_real_distribution<double>(lowest, highest)(generator_);
  }
  std::mt19937_64 generator_{5};
  int count_ = 0;
};

template <class Lobe>
class FreeFrameTest : public testing::Test {
 protected:
  static double fixed(double alpha_x, double alpha_y, const Direction<double>& wi,
                      const Direction<double>& wo) {
    return AnisotropicWard<Lobe>::template basis<double, double>({alpha_x, alpha_y}, wi, wo)[0];
  }
  static double free(double alpha_x, double alpha_y, double psi, const Direction<double>& wi,
                     const Direction<double>& wo) {
    return FreeFrame<AnisotropicWard<Lobe>>::template basis<double, double>({alpha_x, alpha_y, psi},
                                                                            wi, wo)[0];
  }
};
using Lobes = testing::Types<WardLobe, WardApproxLobe, WardDuerLobe, WardGmdLobe>;
TYPED_TEST_SUITE(FreeFrameTest, Lobes);

// A component is wrong by some 4e-16, a slope at 80 degrees (hz >= 0.35) by 1.2e-15; the exponent
// u^2 < 27.6 with u = slope / 0.05 by 2 * 5.3 * 2.4e-14 = 2.5e-13, the value by that share.
constexpr double rounding = 1e-12;
// exp(-27.6) = 1e-12: darker values are not compared.
constexpr double dark = 1e-12;

TYPED_TEST(FreeFrameTest, IsTheTermSeenFromTheTangent) {
  Draws draws;
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const Draw d = draws.next();
    const double expected = this->fixed(d.alpha_x, d.alpha_y, d.wi(-d.psi), d.wo(-d.psi));
    const double value = this->free(d.alpha_x, d.alpha_y, d.psi, d.wi(), d.wo());
    if (expected < dark) {
      EXPECT_LT(value, 2 * dark);
      continue;
    }
    EXPECT_NEAR(value / expected, 1, rounding);
    ++compared;
  }
  EXPECT_GT(compared, 1000) << "the draws miss the lobes";
}

TYPED_TEST(FreeFrameTest, IsTheTermItselfForAnAngleOfZero) {
  Draws draws;
  for (int i = 0; i < 200; ++i) {
    const Draw d = draws.next();
    EXPECT_EQ(this->free(d.alpha_x, d.alpha_y, 0, d.wi(), d.wo()),
              this->fixed(d.alpha_x, d.alpha_y, d.wi(), d.wo()));
  }
}

TYPED_TEST(FreeFrameTest, HalfATurnChangesNothing) {
  Draws draws;
  for (int i = 0; i < 500; ++i) {
    const Draw d = draws.next();
    const double value = this->free(d.alpha_x, d.alpha_y, d.psi, d.wi(), d.wo());
    if (value < dark) continue;
    for (const double half_turn : {-pi, pi}) {
      const double turned = this->free(d.alpha_x, d.alpha_y, d.psi + half_turn, d.wi(), d.wo());
      EXPECT_NEAR(turned / value, 1, rounding);
    }
  }
}

TYPED_TEST(FreeFrameTest, AQuarterTurnSwapsTheRoughnesses) {
  Draws draws;
  for (int i = 0; i < 500; ++i) {
    const Draw d = draws.next();
    const double value = this->free(d.alpha_x, d.alpha_y, d.psi, d.wi(), d.wo());
    if (value < dark) continue;
    const double swapped = this->free(d.alpha_y, d.alpha_x, d.psi + pi / 2, d.wi(), d.wo());
    EXPECT_NEAR(swapped / value, 1, rounding);
  }
}

TYPED_TEST(FreeFrameTest, AWrongSenseOfTurningWouldBeSeen) {
  // The lobe is wide along the tangent, where alpha_x is large: brighter at azimuth psi than -psi.
  const Direction<double> wi = direction_from_degrees(0, 0);
  const double along = this->free(0.4, 0.1, pi / 6, wi, direction_from_degrees(30, 30));
  const double mirrored = this->free(0.4, 0.1, pi / 6, wi, direction_from_degrees(30, -30));
  EXPECT_GT(along, 10 * mirrored);
}

TYPED_TEST(FreeFrameTest, JetDerivativesAgreeWithFiftyDigitDifferences) {
  using Jet = ceres::Jet<double, 3>;
  using Free = FreeFrame<AnisotropicWard<TypeParam>>;
  const Digits step("1e-15");  // truncation 1e-30 / alpha^2, cancellation 1e-35 of 50 digits
  const auto in_digits = [](const Direction<double>& w) {
    return Direction<Digits>{tests::exact(w.x), tests::exact(w.y), tests::exact(w.z)};
  };
  Draws draws;
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const Draw d = draws.next();
    const std::array<double, 3> at{d.alpha_x, d.alpha_y, d.psi};
    const Jet jet = Free::template basis<Jet, double>({Jet(at[0], 0), Jet(at[1], 1), Jet(at[2], 2)},
                                                      d.wi(), d.wo())[0];
    if (jet.a < dark) continue;
    for (std::size_t j = 0; j < 3; ++j) {
      const auto value_at = [&](const Digits& offset) {
        std::array<Digits, 3> theta{Digits(at[0]), Digits(at[1]), Digits(at[2])};
        theta[j] += offset;
        return Free::template basis<Digits, Digits>(theta, in_digits(d.wi()), in_digits(d.wo()))[0];
      };
      const Digits by_difference = (value_at(step) - value_at(-step)) / (2 * step);
      // The exponent is below 27.6; its derivatives by alpha reach 2 * 27.6 / alpha, by psi 27.6 *
      // (ax/ay + ay/ax). Their parts may cancel, so that their scale is what rounding is held to.
      const double scale = jet.a * 60 * (j < 2 ? 1 / at[j] : 20);
      EXPECT_NEAR(jet.v[Eigen::Index(j)], by_difference.template convert_to<double>(),
                  rounding * scale);
    }
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TYPED_TEST(FreeFrameTest, TurningTheDirectionsIsTurningTheTangentBack) {
  // Jets as directions too: the first derivative is by psi, the second by a turn of wi and wo.
  using Jet = ceres::Jet<double, 2>;
  const auto turning = [](const Direction<double>& w) {
    Direction<Jet> jets{Jet(w.x), Jet(w.y), Jet(w.z)};
    jets.x.v[1] = -w.y;
    jets.y.v[1] = w.x;
    return jets;
  };
  Draws draws;
  int compared = 0;
  for (int i = 0; i < 200; ++i) {
    const Draw d = draws.next();
    const Jet jet = FreeFrame<AnisotropicWard<TypeParam>>::template basis<Jet, Jet>(
        {Jet(d.alpha_x), Jet(d.alpha_y), Jet(d.psi, 0)}, turning(d.wi()), turning(d.wo()))[0];
    if (jet.a < dark) continue;
    const double value = this->free(d.alpha_x, d.alpha_y, d.psi, d.wi(), d.wo());
    EXPECT_NEAR(jet.a / value, 1, rounding) << "Jets divide by way of the reciprocal";
    EXPECT_NEAR(jet.v[0], -jet.v[1], rounding * jet.a * 60 * 20);  // as above
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TYPED_TEST(FreeFrameTest, IsFiniteAtTheExtremesAndZeroBelowTheHorizon) {
  constexpr double smallest = std::numeric_limits<double>::denorm_min();
  for (const double cos_i : {1.0, 1e-3, 1e-10, 1e-160, smallest, 0.0, -1e-3}) {
    for (const double cos_o : {1.0, 1e-3, 1e-10, 1e-160, smallest}) {
      for (const double phi : {0.0, 1.0, pi, -2.5}) {
        const Direction<double> wi{std::sqrt(1 - cos_i * cos_i), 0, cos_i};
        const double sin_o = std::sqrt(1 - cos_o * cos_o);
        const Direction<double> wo{sin_o * std::cos(phi), sin_o * std::sin(phi), cos_o};
        for (const double alpha : {1e-4, 10.0}) {
          for (const double psi : {-pi / 2, 0.3, pi / 2}) {
            const double value = this->free(alpha, 0.1, psi, wi, wo);
            ASSERT_TRUE(std::isfinite(value) && value >= 0)
                << value << " at cosines " << cos_i << ", " << cos_o << ", azimuth " << phi;
            ASSERT_TRUE(cos_i > 0 || value == 0) << value;
          }
        }
      }
    }
  }
}

template <class T>
constexpr bool is_free_frame = false;
template <Term T>
constexpr bool is_free_frame<FreeFrame<T>> = true;

template <std::size_t... I>
constexpr bool starts_with_terms(std::index_sequence<I...> /*indices*/) {
  return (std::is_same_v<std::tuple_element_t<I, EvaluatedTerms>, std::tuple_element_t<I, Terms>> &&
          ...);
}

template <class... T>
constexpr int free_frames_in(const std::tuple<T...>* /*terms*/) {
  return (0 + ... + int(is_free_frame<T>));
}

TEST(EvaluatedTermsTest, AreTheUsersListAndTheAnisotropicOnesAgain) {
  EXPECT_TRUE(starts_with_terms(std::make_index_sequence<std::tuple_size_v<Terms>>()));
  EXPECT_EQ(free_frames_in(static_cast<Terms*>(nullptr)), 0);
  const auto anisotropic =
      std::count_if(all_terms().begin(), all_terms().end(),
                    [](const TermEntry& term) { return term.description.anisotropic; });
  EXPECT_EQ(free_frames_in(static_cast<EvaluatedTerms*>(nullptr)), anisotropic);
  EXPECT_EQ(std::tuple_size_v<EvaluatedTerms>, all_terms().size() + std::size_t(anisotropic));
}

TEST(EvaluatedTermsTest, ATermIsAnisotropicIfItsNameSaysSo) {
  for (const TermEntry& term : all_terms()) {
    EXPECT_EQ(term.description.anisotropic, term.description.name.ends_with("-aniso"))
        << term.description.name;
  }
}

}  // namespace
}  // namespace gonio::brdf
