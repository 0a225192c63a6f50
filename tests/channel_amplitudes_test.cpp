// The amplitudes of one channel are the best that there are: against a brute search and against
// closed forms, for coefficients that are linear, affine and nonlinear in them.
#include "fit/channel_amplitudes.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace gonio::tests {
namespace {

/// A model of one channel, with the user's bounds.
struct Channel {
  explicit Channel(const std::string& name, const std::vector<fit::ParameterBounds>& bounds = {})
      : model(name),
        box(fit::box_of(model, std::array{std::string("Y")}, {.bounds = bounds})),
        free(box, 0) {}
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  Eigen::VectorXd solve(const Eigen::MatrixXd& basis, const Eigen::VectorXd& values) const {
    return fit::solve_amplitudes(batch, free, basis, values);
  }

  brdf::Model model;
  fit::BatchModel batch{model};
  fit::Box box;
  fit::FreeAmplitudes free;
};

/// The coefficients as the models' formulas have them.
using Coefficients = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

struct Case {
  std::string name, model;
  std::vector<fit::ParameterBounds> bounds;
  Coefficients coefficients;
};

Eigen::VectorXd of_ashikhmin_shirley(const Eigen::VectorXd& a) {
  return Eigen::Vector3d(a[0] * (1 - a[1]), a[1], 1);
}
Eigen::VectorXd of_oren_nayar_full(const Eigen::VectorXd& a) {
  return Eigen::Vector2d(a[0], a[0] * a[0]);
}

std::vector<Case> cases() {
  const auto full_and_share = [](const Eigen::VectorXd& a) -> Eigen::VectorXd {
    return Eigen::Vector4d(a[0], a[0] * a[0], a[1], 1);
  };
  return {{"coupled", "ashikhmin-shirley", {}, of_ashikhmin_shirley},
          {"coupled_in_a_box",
           "ashikhmin-shirley",
           {{"Rd", .1, .6}, {"Rs", .2, .7}},
           of_ashikhmin_shirley},
          {"coupled_with_a_least_Rs", "ashikhmin-shirley", {{"Rs", .3, 1}}, of_ashikhmin_shirley},
          {"coupled_with_fixed_Rd", "ashikhmin-shirley", {{"Rd", .4, .4}}, of_ashikhmin_shirley},
          {"coupled_with_fixed_Rs", "ashikhmin-shirley", {{"Rs", .4, .4}}, of_ashikhmin_shirley},
          {"full", "oren-nayar-full", {}, of_oren_nayar_full},
          {"full_in_a_box", "oren-nayar-full", {{"rho_d", .2, .9}}, of_oren_nayar_full},
          {"full_and_share", "oren-nayar-full+ashikhmin-shirley", {}, full_and_share},
          {"affine", "strauss", {}, [](const auto& a) { return Eigen::Vector2d(a[0], 1); }},
          {"affine_in_a_box",
           "strauss",
           {{"c", .3, .5}},
           [](const auto& a) { return Eigen::Vector2d(a[0], 1); }},
          {"linear_and_affine", "lambert+ashikhmin-shirley", {}, [](const auto& a) {
             return Eigen::Vector3d(a[0], a[1], 1);
           }}};
}

/// The least |basis * coefficients - values|^2 over the box, cut at `top`: on a grid, and then on
/// ever smaller ones about the best point so far.
double brute_minimum(const Coefficients& coefficients, const Channel& channel,
                     const Eigen::MatrixXd& basis, const Eigen::VectorXd& values) {
  constexpr double top = 30;
  const Eigen::Index dimensions = channel.free.lower.size();
  const Eigen::VectorXd lower = channel.free.lower;
  const Eigen::VectorXd upper = channel.free.upper.cwiseMin(top);
  double least = INFINITY;
  Eigen::VectorXd best = lower;
  const auto search = [&](const Eigen::VectorXd& from, const Eigen::VectorXd& to, int points) {
    Eigen::VectorXd at(dimensions);
    for (int i = 0; i < int(std::pow(points, dimensions)); ++i) {
      for (int k = 0, rest = i; k < dimensions; ++k, rest /= points) {
        at[k] = from[k] + (to[k] - from[k]) * (rest % points) / (points - 1);
      }
      const double square = (basis * coefficients(at) - values).squaredNorm();
      if (!(square < least)) continue;
      least = square;
      best = at;
    }
  };
  const int first = dimensions == 1 ? 1001 : 61;
  search(lower, upper, first);
  Eigen::VectorXd reach = (upper - lower) * 2 / (first - 1);
  for (int round = 0; round < 30; ++round, reach *= 0.5) {
    const Eigen::VectorXd from = (best - reach).cwiseMax(lower);
    const Eigen::VectorXd to = (best + reach).cwiseMin(upper);
    search(from, to, 7);
  }
  return least;
}

class SolvedAmplitudes : public testing::TestWithParam<Case> {
 protected:
  static double uniform(std::mt19937_64& random, double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random);
  }

  /// Basis functions are not negative; the values are those of a material, more or less: some of
  /// them white, some all specular, and with an error of up to `error` times their size.
  void expect_no_worse_than_brute(double error, int draws) const {
    const Case& c = GetParam();
    const Channel channel(c.model, c.bounds);
    const auto rows = Eigen::Index(channel.batch.basis_size()) + 1;
    std::mt19937_64 random(17);
    for (int draw = 0; draw < draws; ++draw) {
      Eigen::MatrixXd basis(rows, rows - 1);
      for (double& x : basis.reshaped()) x = uniform(random, 0, 1);
      Eigen::VectorXd truth(channel.free.lower.size());
      for (Eigen::Index k = 0; k < truth.size(); ++k) {
        const double upper = std::min(channel.free.upper[k], 1.2);
        truth[k] = draw % 3 == 1 ? upper : uniform(random, channel.free.lower[k], upper);
      }
      Eigen::VectorXd values = basis * c.coefficients(truth);
      const double size = error * values.norm();
      for (double& x : values) x += uniform(random, -size, size);

      const Eigen::VectorXd found = channel.solve(basis, values);
      ASSERT_TRUE((found.array() >= channel.free.lower.array()).all()) << found.transpose();
      ASSERT_TRUE((found.array() <= channel.free.upper.array()).all()) << found.transpose();
      const double square = (basis * c.coefficients(found) - values).squaredNorm();
      // Roundings of a square of residuals, each 1e-16 of the values.
      const double rounding = 1e-14 * values.squaredNorm();
      ASSERT_LE(square, brute_minimum(c.coefficients, channel, basis, values) + rounding)
          << "draw " << draw << ": " << found.transpose() << "; the truth was "
          << truth.transpose();
    }
  }
};

TEST_P(SolvedAmplitudes, AreTheTruthWithoutNoise) { expect_no_worse_than_brute(0, 60); }
TEST_P(SolvedAmplitudes, AreTheBestOfNoisyData) { expect_no_worse_than_brute(0.05, 100); }
TEST_P(SolvedAmplitudes, AreTheBestOfDataThatNoAmplitudesMake) {
  expect_no_worse_than_brute(1, 100);
}

INSTANTIATE_TEST_SUITE_P(Of, SolvedAmplitudes, testing::ValuesIn(cases()),
                         [](const auto& instance) { return instance.param.name; });

/// The amplitudes for the basis functions e1, e2, e3: the coefficients nearest to the values.
Eigen::VectorXd nearest_coupled(double a, double rs,
                                const std::vector<fit::ParameterBounds>& bounds = {}) {
  return Channel("ashikhmin-shirley", bounds)
      .solve(Eigen::Matrix3d::Identity(), Eigen::Vector3d(a, rs, 1));
}

void expect_amplitudes(const Eigen::VectorXd& found, double rd, double rs) {
  EXPECT_NEAR(found[0], rd, 1e-14);
  EXPECT_NEAR(found[1], rs, 1e-14);
}

TEST(CoupledAmplitudes, AreTheNearestPointOfATriangle) {
  // Rd (1 - Rs) and Rs fill the triangle with the corners (0, 0), (1, 0), (0, 1).
  expect_amplitudes(nearest_coupled(0.3, 0.4), 0.5, 0.4);         // inside
  expect_amplitudes(nearest_coupled(-0.3, 0.4), 0, 0.4);          // the edge Rd = 0
  expect_amplitudes(nearest_coupled(0.3, -0.4), 0.3, 0);          // the edge Rs = 0
  expect_amplitudes(nearest_coupled(0.9, 0.95), 1, 0.525);        // the edge Rd = 1
  expect_amplitudes(nearest_coupled(0.9, 0.05 + 0.9), 1, 0.525);  // and its foot
  expect_amplitudes(nearest_coupled(-1, -1), 0, 0);               // the corners
  expect_amplitudes(nearest_coupled(3, 0), 1, 0);
  // At the corner Rs = 1 nothing is left of the layer below: Rd is as near to 0 as it may be.
  expect_amplitudes(nearest_coupled(-0.1, 1.3), 0, 1);
  expect_amplitudes(nearest_coupled(0.1, 1.3), 0, 1);
  expect_amplitudes(nearest_coupled(0.1, 1.3, {{"Rd", .2, .7}}), 0.2, 1);
}

TEST(CoupledAmplitudes, LeaveTheCornerWhereAnotherDiffuseShareGains) {
  // Beyond the edge Rd = 1. Steps from 0 lead to Rs = 1, where Rd counts for nothing and, being
  // small, hides that less of Rs and all of Rd is better.
  for (const double excess : {0.2, 0.3, 0.4, 0.5, 0.6}) {
    expect_amplitudes(nearest_coupled(0.1 + excess, 0.9 + excess), 1, 0.9);
  }
}

TEST(CoupledAmplitudes, StayWithinTheUsersBounds) {
  expect_amplitudes(nearest_coupled(0.3, 0.4, {{"Rd", .2, .2}}), 0.2,
                    // a = (1 - Rs) / 5: the foot of the perpendicular
                    (0.4 - 0.2 * (0.3 - 0.2)) / 1.04);
  expect_amplitudes(nearest_coupled(0.3, 0.4, {{"Rs", .7, .7}}), 1, 0.7);
  expect_amplitudes(nearest_coupled(0.3, 0.4, {{"Rs", .1, .2}}), 0.375, 0.2);
  expect_amplitudes(nearest_coupled(0.3, 0.4, {{"Rd", .1, .3}, {"Rs", .1, .2}}), 0.3, 0.2);
  expect_amplitudes(nearest_coupled(0.3, 0.4, {{"Rd", 1, 1}, {"Rs", 0, 0}}), 1, 0);
}

TEST(CoupledAmplitudes, WithoutInfluenceAreZero) {
  const Channel channel("ashikhmin-shirley");
  Eigen::Matrix3d basis = Eigen::Matrix3d::Identity();
  basis(0, 0) = 0;
  expect_amplitudes(channel.solve(basis, Eigen::Vector3d(.3, .4, 1)), 0, 0.4);
  basis(1, 1) = 0;
  expect_amplitudes(channel.solve(basis, Eigen::Vector3d(.3, .4, 1)), 0, 0);
  // Two columns that are the same: any share of both will do.
  basis << 1, 1, 0, 1, 1, 0, 0, 0, 1;
  const Eigen::VectorXd found = channel.solve(basis, Eigen::Vector3d(.6, .6, 1));
  EXPECT_NEAR(found[0] * (1 - found[1]) + found[1], 0.6, 1e-14);
}

TEST(AmplitudesOfAnyUnit, AreTheSameForHugeAndTinyValues) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Case& c : cases()) {
    const Channel channel(c.model, c.bounds);
    const auto size = Eigen::Index(channel.batch.basis_size());
    for (int draw = 0; draw < 20; ++draw) {
      Eigen::MatrixXd basis(size, size);
      Eigen::VectorXd values(size);
      for (double& x : basis.reshaped()) x = uniform(random);
      for (double& x : values) x = 2 * uniform(random) - 0.3;
      const Eigen::VectorXd expected = channel.solve(basis, values);
      // Squares reach 1e300 and 1e-300.
      for (const double scale : {1e150, 1e-150}) {
        const Eigen::VectorXd found = channel.solve(scale * basis, scale * values);
        // Amplitudes of nearly the same square differ by the root of its rounding.
        EXPECT_LE((found - expected).norm(), 1e-6 * (1 + expected.norm()))
            << c.name << " " << scale << ": " << found.transpose() << " for "
            << expected.transpose();
      }
    }
  }
}

/// (rho - v1)^2 + (rho^2 - v2)^2 is a quartic: one minimum, or two.
TEST(FullOrenNayarAmplitude, IsTheLeastRootOfAQuarticHoweverFarTheDataAre) {
  const Channel channel("oren-nayar-full");
  int with_two_minima = 0;
  for (double v1 = -2; v1 <= 2; v1 += 0.125) {
    for (double v2 = -3; v2 <= 5; v2 += 0.125) {
      const auto square = [&](double rho) {
        return std::pow(rho - v1, 2) + std::pow(rho * rho - v2, 2);
      };
      const auto slope = [&](double rho) { return 2 * (rho - v1) + 4 * rho * (rho * rho - v2); };
      const double rho = channel.solve(Eigen::Matrix2d::Identity(), Eigen::Vector2d(v1, v2))[0];
      for (int i = 0; i <= 500; ++i) {
        ASSERT_LE(square(rho), square(0.01 * i) + 1e-14) << v1 << " " << v2 << " " << rho;
      }
      // The slope's own parts are below 1e3 and their roundings below 1e-13.
      if (rho > 0) {
        EXPECT_NEAR(slope(rho), 0, 1e-9) << v1 << " " << v2 << " " << rho;
      } else {
        EXPECT_GE(slope(0), 0);
      }
      with_two_minima += v1 < 0 && rho > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(with_two_minima, 100) << "the values are too tame";
}

}  // namespace
}  // namespace gonio::tests
