// Ashikhmin and Shirley's model against its printed formulas in 50 digits, closed-form albedos, and
// the plain forms of its parts in float.
#include "brdf/ashikhmin_shirley.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "brdf/lambert.h"
#include "tests/ashikhmin_shirley_reference.h"
#include "tests/directions.h"

namespace gonio::tests {
namespace {

using brdf::Direction;
using Isotropic = brdf::AshikhminShirley<brdf::IsotropicExponent>;
using Anisotropic = brdf::AshikhminShirley<brdf::AnisotropicExponents>;
using CoupledIsotropic = brdf::CoupledAshikhminShirley<brdf::IsotropicExponent>;
using Coupled = brdf::CoupledAshikhminShirley<brdf::AnisotropicExponents>;

/// f_r of the coupled model in 1/sr.
template <class D>
D f_r(D rd, D rs, D nu, D nv, const Direction<D>& wi, const Direction<D>& wo) {
  const auto coefficients = brdf::coefficients_of<Coupled, D>({rd, rs});
  const auto basis = Coupled::basis<D, D>({nu, nv}, wi, wo);
  return coefficients[0] * basis[0] + coefficients[1] * basis[1] + coefficients[2] * basis[2];
}

struct Draw {
  Direction<double> wi, wo;
  double nu, nv, rd, rs;
};

/// Exponents from 0 up, 1 + n log-uniform; every other half vector within the lobe, so that sharp
/// lobes are met and not only their dark surroundings.
class Draws {
 public:
  explicit Draws(double largest_exponent) : largest_exponent_(largest_exponent) {}

  Draw next() {
    const double nu = exponent();
    const double nv = exponent();
    const Direction<double> wi = on_hemisphere();
    Direction<double> wo = on_hemisphere();
    if (count_++ % 2 == 0) {
      const double radius = std::sqrt(-2 * std::log(uniform(1e-9, 1)));
      const double phi = uniform(0, 2 * std::numbers::pi);
      wo = mirrored_about_slopes(wi, radius / std::sqrt(nu + 1) * std::cos(phi),
                                 radius / std::sqrt(nv + 1) * std::sin(phi));
    }
    return wo.z > 0 ? Draw{wi, wo, nu, nv, uniform(0, 1), uniform(0, 1)} : next();
  }

 private:
  double uniform(double lowest, double highest) {
    return std::uniform_real_distribution<double>(lowest, highest)(generator_);
  }
  double exponent() { return std::expm1(uniform(0, std::log1p(largest_exponent_))); }
  Direction<double> on_hemisphere() {
    return brdf::direction_from_radians(std::acos(uniform(1e-3, 1)),
                                        uniform(0, 2 * std::numbers::pi));
  }

  std::mt19937_64 generator_{2000};
  double largest_exponent_;
  int count_ = 0;
};

struct Errors {
  double relative = 0;
  double of_peak = 0;
};

/// The worst errors of f_r and of its three basis functions over draws, where the lobe is above
/// 1e-12 of its value at the mirror direction.
template <class D>
Errors worst_errors(double largest_exponent) {
  Draws draws(largest_exponent);
  Errors worst;
  int compared = 0;
  for (int i = 0; i < 4000; ++i) {
    const Draw draw = draws.next();
    const auto wi = as<D>(draw.wi);
    const auto wo = as<D>(draw.wo);
    const D nu = static_cast<D>(draw.nu);
    const D nv = static_cast<D>(draw.nv);
    const D rd = static_cast<D>(draw.rd);
    const D rs = static_cast<D>(draw.rs);
    const auto truth = ashikhmin_shirley_reference(exact(nu), exact(nv), wi, wo);
    const auto basis = Coupled::basis<D, D>({nu, nv}, wi, wo);
    if (truth.decay > std::log(1e12)) {
      const Digits peak = truth.specular * exp(truth.decay);
      EXPECT_LE(exact(basis[1]),
                1.01 * truth.specular + std::numeric_limits<D>::denorm_min() * (1 + peak));
      continue;
    }
    const double height = Digits(exp(-truth.decay)).template convert_to<double>();
    const auto compare = [&](D value, const Digits& expected) {
      worst.relative = std::max(worst.relative, relative_error(value, expected));
      worst.of_peak = std::max(worst.of_peak, relative_error(value, expected) * height);
    };
    compare(basis[0], truth.diffuse);
    compare(basis[1], truth.specular * (1 - truth.darkness));
    compare(basis[2], truth.specular * truth.darkness);
    compare(f_r(rd, rs, nu, nv, wi, wo), truth.value(exact(rd), exact(rs)));
    ++compared;
  }
  EXPECT_GT(compared, 2000) << "the draws miss the lobes";
  return worst;
}

// The decay is at most 27.6; some 10 half-ulps of 1.1e-16 of that are 3e-14.
TEST(AshikhminShirleyTest, DoubleAgreesWithFiftyDigits) {
  EXPECT_LE(worst_errors<double>(1e6).relative, 1e-13);
  EXPECT_LE(worst_errors<double>(2).relative, 1e-13) << "small exponents";
}

// x exp(-x) is at most 0.37; the fifth power and the denominator add 20 half-ulps of 6e-8.
TEST(AshikhminShirleyTest, FloatAgreesWithFiftyDigitsToMillionthsOfThePeak) {
  EXPECT_LE(worst_errors<float>(1e6).of_peak, 2e-6);
  EXPECT_LE(worst_errors<float>(2).of_peak, 2e-6) << "small exponents";
}

TEST(AshikhminShirleyTest, IsReciprocalToRounding) {
  Draws draws(1e6);
  for (int i = 0; i < 4000; ++i) {
    const Draw d = draws.next();
    EXPECT_DOUBLE_EQ(f_r(d.rd, d.rs, d.nu, d.nv, d.wi, d.wo),
                     f_r(d.rd, d.rs, d.nu, d.nv, d.wo, d.wi));
  }
}

TEST(AshikhminShirleyTest, IsIsotropicWithEqualExponents) {
  Draws draws(1e4);
  for (int i = 0; i < 500; ++i) {
    const Draw d = draws.next();
    const auto one = CoupledIsotropic::basis<double, double>({d.nu}, d.wi, d.wo);
    const auto two = Coupled::basis<double, double>({d.nu, d.nu}, d.wi, d.wo);
    // cos^2(phi) + sin^2(phi) is 1 to rounding, which the decay of up to 700 multiplies.
    for (std::size_t b = 0; b < 3; ++b) EXPECT_NEAR(one[b], two[b], 1e-12 * one[b]);
  }
}

TEST(AshikhminShirleyTest, TurningTheSampleSwapsTheExponents) {
  Draws draws(1e4);
  const auto turned = [](const Direction<double>& d) { return Direction<double>{-d.y, d.x, d.z}; };
  for (int i = 0; i < 500; ++i) {
    const Draw d = draws.next();
    const auto value = Coupled::basis<double, double>({d.nu, d.nv}, d.wi, d.wo);
    const auto swapped = Coupled::basis<double, double>({d.nv, d.nu}, turned(d.wi), turned(d.wo));
    for (std::size_t b = 0; b < 3; ++b) EXPECT_DOUBLE_EQ(value[b], swapped[b]);
  }
}

TEST(AshikhminShirleyTest, AloneHasTheSpecularPartOfTheWholeModel) {
  Draws draws(1e4);
  for (int i = 0; i < 100; ++i) {
    const Draw d = draws.next();
    const auto whole = Coupled::basis<double, double>({d.nu, d.nv}, d.wi, d.wo);
    const auto alone = Anisotropic::basis<double, double>({d.nu, d.nv}, d.wi, d.wo);
    EXPECT_EQ(alone, (std::array<double, 2>{whole[1], whole[2]}));
    const auto round = Isotropic::basis<double, double>({d.nu}, d.wi, d.wo);
    const auto whole_round = CoupledIsotropic::basis<double, double>({d.nu}, d.wi, d.wo);
    EXPECT_EQ(round, (std::array<double, 2>{whole_round[1], whole_round[2]}));
  }
  EXPECT_EQ((brdf::coefficients_of<Anisotropic, double>({0.3})), (std::array<double, 2>{0.3, 1}));
  EXPECT_EQ(Anisotropic::description.name, Coupled::description.name);
  EXPECT_EQ(Anisotropic::description.companion, brdf::Lambert::description.name);
}

TEST(AshikhminShirleyTest, IsExactlyZeroBelowTheHorizonAndOnIt) {
  const Direction<double> above = brdf::direction_from_degrees(30, 40);
  constexpr std::array<double, 3> zero{};
  for (const double z : {0.0, -0.0, -1e-300, -0.5}) {
    const Direction<double> below{std::sqrt(1 - z * z), 0, z};
    EXPECT_EQ((Coupled::basis<double, double>({10, 20}, below, above)), zero);
    EXPECT_EQ((Coupled::basis<double, double>({10, 20}, above, below)), zero);
    EXPECT_EQ((CoupledIsotropic::basis<double, double>({0}, below, above)), zero);
  }
}

// There n.h = 1, h.wi = cos(theta): sqrt((nu+1)(nv+1)) / (8 pi cos^2(theta)).
TEST(AshikhminShirleyTest, HasItsClosedFormPeakAtTheMirrorDirection) {
  for (const double theta : {0.0, 20.0, 45.0, 70.0, 89.0}) {
    const Direction<double> wi = brdf::direction_from_degrees(theta, 25);
    const Direction<double> wo{-wi.x, -wi.y, wi.z};
    const auto basis = Anisotropic::basis<double, double>({99, 399}, wi, wo);
    EXPECT_NEAR((basis[0] + basis[1]) * 8 * std::numbers::pi * wi.z * wi.z / 200, 1, 2e-15);
    EXPECT_NEAR(basis[1] / (basis[0] + basis[1]), std::pow(1 - wi.z, 5), 1e-15);
  }
}

/// The integral of one basis function times cos_o over the outgoing hemisphere, by the midpoint
/// rule in cos_o and phi.
double albedo(std::size_t basis, double nu, double nv, double theta_i_deg) {
  constexpr int cosine_count = 4000;
  constexpr int phi_count = 64;
  const Direction<double> wi = brdf::direction_from_degrees(theta_i_deg, 0);
  double sum = 0;
  for (int c = 0; c < cosine_count; ++c) {
    const double cosine = (c + 0.5) / cosine_count;
    for (int p = 0; p < phi_count; ++p) {
      const double phi = (p + 0.5) / phi_count * 2 * std::numbers::pi;
      const Direction<double> wo = brdf::direction_from_radians(std::acos(cosine), phi);
      sum += cosine * Coupled::basis<double, double>({nu, nv}, wi, wo)[basis];
    }
  }
  return sum * 2 * std::numbers::pi / (cosine_count * phi_count);
}

// The integral of c (1 - (1 - c/2)^5) over 0..1 is 23/56: with 28/(23 pi) and 2 pi it is 1.
TEST(AshikhminShirleyTest, DiffusePartHasTheAlbedoOfItsClosedForm) {
  for (const double theta : {0.0, 30.0, 60.0, 85.0}) {
    const double cosine = brdf::direction_from_degrees(theta, 0).z;
    EXPECT_NEAR(albedo(0, 10, 10, theta), 1 - std::pow(1 - cosine / 2, 5), 1e-7) << theta;
  }
  EXPECT_NEAR(albedo(0, 10, 10, 0), 31.0 / 32, 1e-7);
}

// At normal incidence cos_o = 2 c^2 - 1, c = n.h = h.wi, and dwo = 4 c dwh, so that the albedo for
// F = 1 is the integral of (n+1) c^n (2 c^2 - 1) for c from sqrt(1/2) to 1.
TEST(AshikhminShirleyTest, SpecularPartHasTheAlbedoOfItsClosedFormAtNormalIncidence) {
  for (const double n : {0.0, 1.0, 10.0, 100.0}) {
    const auto integral = [](double power) {
      return (1 - std::exp2(-(power + 1) / 2)) / (power + 1);
    };
    const double expected = (n + 1) * (2 * integral(n + 2) - integral(n));
    EXPECT_NEAR(albedo(1, n, n, 0) + albedo(2, n, n, 0), expected, 1e-5) << n;
  }
}

/// (n.h)^n of the normalised half vector times sqrt((n+1)(n+1)) / (8 pi (h.wi) max), as shaders
/// have it, for F = 1.
float plain_specular(float n, const Direction<float>& wi, const Direction<float>& wo) {
  const auto h = brdf::half_vector(wi, wo);
  const float length = std::sqrt(h.x * h.x + h.y * h.y + h.z * h.z);
  const float h_wi = (h.x * wi.x + h.y * wi.y + h.z * wi.z) / length;
  return (n + 1) / (8 * std::numbers::pi_v<float>)*std::pow(h.z / length, n) /
         (h_wi * std::max(wi.z, wo.z));
}

float stable_specular(float n, const Direction<float>& wi, const Direction<float>& wo) {
  const auto basis = Isotropic::basis<float, float>({n}, wi, wo);
  return basis[0] + basis[1];
}

// n.h moves in steps of 6e-8: its power 1e4 in steps of 6e-4.
TEST(AshikhminShirleyTest, KeepsTheSharpLobeThatThePlainPowerLosesInFloat) {
  double worst_plain = 0;
  double worst = 0;
  for (int i = 0; i <= 1000; ++i) {
    const auto wi = as<float>(brdf::direction_from_degrees(30, 0));
    const auto wo = as<float>(brdf::direction_from_degrees(30 + 1e-3 * i, 180));
    const auto truth = ashikhmin_shirley_reference(1e4, 1e4, wi, wo);
    const Digits peak = truth.specular * exp(truth.decay);
    const auto error_of = [&](float value) {
      return Digits(abs(exact(value) - truth.specular) / peak).convert_to<double>();
    };
    worst_plain = std::max(worst_plain, error_of(plain_specular(1e4F, wi, wo)));
    worst = std::max(worst, error_of(stable_specular(1e4F, wi, wo)));
  }
  EXPECT_GT(worst_plain, 3e-4);
  EXPECT_LT(worst, 2e-6);
}

// h.(wi + wo) is |h|^2, here 1e-5, but h.wi also has half the difference of |wi|^2 and |wo|^2,
// which are 1 to 1e-7.
TEST(AshikhminShirleyTest, KeepsTheCosineThatTheDotProductLosesAtGrazingAnglesInFloat) {
  double worst_plain = 0;
  double worst = 0;
  for (int i = 0; i <= 1000; ++i) {
    const auto wi = as<float>(brdf::direction_from_degrees(89.9, 0.36 * i));
    const auto wo = as<float>(brdf::direction_from_degrees(89.85, 0.36 * i + 180.05));
    const Digits truth = ashikhmin_shirley_reference(0, 0, wi, wo).specular;
    worst_plain = std::max(worst_plain, relative_error(plain_specular(0, wi, wo), truth));
    worst = std::max(worst, relative_error(stable_specular(0, wi, wo), truth));
  }
  EXPECT_GT(worst_plain, 1e-3);
  EXPECT_LT(worst, 2e-6);
}

}  // namespace
}  // namespace gonio::tests
