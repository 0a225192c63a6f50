// The functions of packs of four doubles against the long double ones of the C library, in the copy
// for any CPU and in the copy for this one; and of Jets of packs against Jets of doubles.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "brdf/pack.h"
#include "fit/pack_jet.h"

namespace gonio::tests {
namespace {

using brdf::Pack;
using Numbers = std::vector<double>;  // a multiple of Pack::size long

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();
constexpr double smallest_normal = std::numeric_limits<double>::min();

/// The same loop with the instructions of any x86-64, and with those of this CPU.
template <class Function>
Numbers on_any_cpu(const Function& function, const Numbers& x) {
  Numbers y(x.size());
  for (std::size_t i = 0; i < x.size(); i += Pack::size) function(Pack::load(&x[i])).store(&y[i]);
  return y;
}
template <class Function>
GONIO_FOR_EACH_CPU void write_on_this_cpu(const double* x, std::size_t count, double* y) {
  for (std::size_t i = 0; i < count; i += Pack::size) {
    Function()(Pack::load(x + i)).store(y + i);
  }
}
template <class Function>
Numbers on_this_cpu(const Function& /*function*/, const Numbers& x) {
  Numbers y(x.size());
  write_on_this_cpu<Function>(x.data(), x.size(), y.data());
  return y;
}

struct Exp {
  Pack operator()(const Pack& x) const { return exp(x); }
};
struct Log {
  Pack operator()(const Pack& x) const { return log(x); }
};
struct Log1p {
  Pack operator()(const Pack& x) const { return log1p(x); }
};
struct Cbrt {
  Pack operator()(const Pack& x) const { return cbrt(x); }
};
struct Sqrt {
  Pack operator()(const Pack& x) const { return sqrt(x); }
};

/// The error in units of the last place of a double of the expected size, denormals included.
double error_in_ulps(double value, long double expected) {
  if (expected == 0) return value == 0 ? 0 : infinity;
  const int exponent = std::max(std::ilogb(expected), -1022);
  return double(std::abs(value - expected) / std::ldexp(1.0L, exponent - 52));
}

/// The largest error over `x` on either CPU; the long double function errs by 2^-11 of such units.
template <class Function, class Reference>
double worst_error(const Function& function, const Reference& reference, const Numbers& x) {
  double worst = 0;
  for (const Numbers& y : {on_any_cpu(function, x), on_this_cpu(function, x)}) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double error = error_in_ulps(y[i], reference(static_cast<long double>(x[i])));
      EXPECT_FALSE(std::isnan(error)) << x[i] << " gives " << y[i];
      worst = std::max(worst, error);
    }
  }
  return worst;
}

Numbers uniform(double lowest, double highest, std::size_t count = 200'000) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> draw(lowest, highest);
  Numbers x(count);
  for (double& value : x) value = draw(random);
  return x;
}

/// Uniform in the exponent of two.
Numbers of_all_sizes(double least_exponent, double largest_exponent) {
  Numbers x = uniform(least_exponent, largest_exponent);
  for (double& value : x) value = std::exp2(value);
  return x;
}

/// Neighbours of 1, where a logarithm loses its digits.
Numbers near_one() {
  Numbers x;
  for (int k = 1; k <= 1000; ++k) {
    x.push_back(1 + k * 0x1p-52);
    x.push_back(1 - k * 0x1p-53);
    x.push_back(1 + std::exp2(-k * 0.05));
    x.push_back(1 - std::exp2(-1 - k * 0.05));
  }
  return x;
}

TEST(ExpOfPacks, IsExactToTwoUnitsInTheLastPlace) {
  const auto reference = [](long double x) { return std::exp(x); };
  EXPECT_LE(worst_error(Exp(), reference, uniform(-708.3, 709.78)), 2);
  EXPECT_LE(worst_error(Exp(), reference, uniform(-1, 1)), 2);
  EXPECT_LE(worst_error(Exp(), reference, uniform(-745, -708)), 2) << "denormal results";
  Numbers tiny = of_all_sizes(-1074, 0);
  EXPECT_LE(worst_error(Exp(), reference, tiny), 2);
  for (double& x : tiny) x = -x;
  EXPECT_LE(worst_error(Exp(), reference, tiny), 2);
}

TEST(ExpOfPacks, EndsInZeroAndInfinity) {
  const Numbers x{-745.2, -1e3, -largest, -infinity, 709.8, 1e3, largest, infinity};
  for (const Numbers& y : {on_any_cpu(Exp(), x), on_this_cpu(Exp(), x)}) {
    EXPECT_EQ(y, (Numbers{0, 0, 0, 0, infinity, infinity, infinity, infinity}));
  }
  // ln of the largest double, rounded down, and of the smallest normal one: no step of the way
  // overflows, or loses digits as a denormal, before the result does.
  const Numbers ends{709.782712893384, -708.3964185322641, 0, -0.0};
  const auto reference = [](long double e) { return std::exp(e); };
  EXPECT_LE(worst_error(Exp(), reference, ends), 2);
  EXPECT_EQ(on_this_cpu(Exp(), ends)[2], 1);
}

TEST(LogOfPacks, IsExactToTwoUnitsInTheLastPlace) {
  const auto reference = [](long double x) { return std::log(x); };
  EXPECT_LE(worst_error(Log(), reference, of_all_sizes(-1022, 1023.99)), 2);
  EXPECT_LE(worst_error(Log(), reference, uniform(0.5, 2)), 2);
  EXPECT_LE(worst_error(Log(), reference, near_one()), 2);
  // Where the mantissa is halved, and the ends of the range.
  const double root = std::numbers::sqrt2;
  EXPECT_LE(worst_error(Log(), reference,
                        {std::nextafter(root, 0), root, std::nextafter(root, 2), 1, smallest_normal,
                         largest, 2, 0.5}),
            2);
  EXPECT_EQ(on_this_cpu(Log(), Numbers(4, 1.0)), Numbers(4, 0.0));
}

TEST(Log1pOfPacks, IsExactToThreeUnitsInTheLastPlace) {
  const auto reference = [](long double x) { return std::log1p(x); };
  EXPECT_LE(worst_error(Log1p(), reference, uniform(-1 + 0x1p-53, 3)), 3);
  Numbers sizes = of_all_sizes(-1074, 1023.99);
  EXPECT_LE(worst_error(Log1p(), reference, sizes), 3);
  for (double& x : sizes) x = -std::min(x, 0.99);
  EXPECT_LE(worst_error(Log1p(), reference, sizes), 3);
  // Where the sum is rounded most, where the mantissa of the sum is halved, and the ends.
  const double halved = std::numbers::sqrt2 - 1;
  EXPECT_LE(worst_error(Log1p(), reference,
                        {0x1p-53, -0x1p-54, 0x1.8p-53, 0x1p53 + 2, std::nextafter(halved, 0),
                         halved, std::nextafter(halved, 1), -1 + 0x1p-53, largest, 1e300,
                         smallest_normal, -std::numeric_limits<double>::denorm_min()}),
            3);
  EXPECT_EQ(on_this_cpu(Log1p(), Numbers(4, 0.0)), Numbers(4, 0.0));
}

TEST(CbrtOfPacks, IsExactToTwoUnitsInTheLastPlace) {
  const auto reference = [](long double x) { return std::cbrt(x); };
  // log2 of 1e-300 and of a third of the largest number.
  EXPECT_LE(worst_error(Cbrt(), reference, of_all_sizes(-996.57, 1022.3)), 2);
  EXPECT_LE(worst_error(Cbrt(), reference, uniform(0, 10)), 2);
  const Numbers cubes{1, 8, 27, 1e-300};
  EXPECT_LE(worst_error(Cbrt(), reference, cubes), 2);
}

TEST(CbrtOfPacks, IsZeroBelowWhatItPromises) {
  const Numbers x{0, 9.9e-301, smallest_normal, std::numeric_limits<double>::denorm_min()};
  EXPECT_EQ(on_any_cpu(Cbrt(), x), Numbers(4, 0.0));
  EXPECT_EQ(on_this_cpu(Cbrt(), x), Numbers(4, 0.0));
}

TEST(SqrtOfPacks, IsCorrectlyRounded) {
  // 0.5 ulp by IEEE 754, and the long double root's own rounding.
  const auto reference = [](long double x) { return std::sqrt(x); };
  EXPECT_LE(worst_error(Sqrt(), reference, of_all_sizes(-1074, 1023.99)), 0.5 + 0x1p-10);
  EXPECT_EQ(on_this_cpu(Sqrt(), {0, infinity, 4, 1e-320})[0], 0);
}

/// Every kind of double.
Numbers of_every_kind() {
  return {0.0,     -0.0,     1.5,      -1.5,      1e-320,       -1e-320,
          largest, -largest, infinity, -infinity, std::nan(""), -std::nan("")};
}

TEST(PacksOfEveryKindOfNumber, TakeSignsAsTheCLibraryDoes) {
  const Numbers kinds = of_every_kind();
  for (std::size_t i = 0; i < kinds.size(); i += Pack::size) {
    const Pack x = Pack::load(&kinds[i]);
    for (const double sign : kinds) {
      const Pack magnitude = abs(x);
      const Pack signed_as = copysign(x, Pack(sign));
      for (std::size_t lane = 0; lane < Pack::size; ++lane) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(magnitude[lane]),
                  std::bit_cast<std::uint64_t>(std::abs(kinds[i + lane])));
        EXPECT_EQ(std::bit_cast<std::uint64_t>(signed_as[lane]),
                  std::bit_cast<std::uint64_t>(std::copysign(kinds[i + lane], sign)));
      }
    }
  }
}

TEST(PacksOfEveryKindOfNumber, AreComparedAndChosenLaneByLane) {
  const Numbers kinds = of_every_kind();
  for (std::size_t i = 0; i < kinds.size(); i += Pack::size) {
    const Pack a = Pack::load(&kinds[i]);
    for (const double b : kinds) {
      const Pack chosen = select(less(a, Pack(b)), Pack(1), Pack(2));
      const Pack in_range = select(both(less(a, Pack(b)), less(Pack(-2), a)), 1, 2);
      const Pack larger = brdf::larger(a, Pack(b));
      for (std::size_t lane = 0; lane < Pack::size; ++lane) {
        const double x = kinds[i + lane];
        EXPECT_EQ(chosen[lane], x < b ? 1 : 2) << x << " < " << b;
        EXPECT_EQ(in_range[lane], x < b && -2 < x ? 1 : 2) << x << " < " << b;
        EXPECT_EQ(std::bit_cast<std::uint64_t>(larger[lane]),
                  std::bit_cast<std::uint64_t>(x < b ? b : x));
      }
    }
  }
}

TEST(PacksOfEveryKindOfNumber, HaveTheAnglesOfTheCLibrary) {
  const Numbers kinds = of_every_kind();
  for (std::size_t i = 0; i < kinds.size(); i += Pack::size) {
    for (const double x : kinds) {
      const Pack angle = atan2(Pack::load(&kinds[i]), Pack(x));
      for (std::size_t lane = 0; lane < Pack::size; ++lane) {
        const double expected = std::atan2(kinds[i + lane], x);
        EXPECT_TRUE(std::bit_cast<std::uint64_t>(angle[lane]) ==
                        std::bit_cast<std::uint64_t>(expected) ||
                    (std::isnan(angle[lane]) && std::isnan(expected)))
            << kinds[i + lane] << ", " << x;
      }
    }
  }
}

/// Lane `lane` of a Jet of packs.
ceres::Jet<double, 2> lane_of(const ceres::Jet<Pack, 2>& jet, std::size_t lane) {
  ceres::Jet<double, 2> scalar(jet.a[lane]);
  for (int k = 0; k < 2; ++k) scalar.v[k] = jet.v[k][lane];
  return scalar;
}

/// The function of two variables on a Jet of packs against the same on Jets of doubles.
template <class Function>
void expect_the_jets_of_doubles(const Function& function, const std::array<double, 4>& x,
                                const std::array<double, 4>& y) {
  using PackJet = ceres::Jet<Pack, 2>;
  using Jet = ceres::Jet<double, 2>;
  const PackJet packs =
      function(PackJet(Pack::load(x.data()), 0), PackJet(Pack::load(y.data()), 1));
  for (std::size_t lane = 0; lane < Pack::size; ++lane) {
    const Jet expected = function(Jet(x[lane], 0), Jet(y[lane], 1));
    const Jet value = lane_of(packs, lane);
    // The functions of packs may be another by 3 units in the last place, of 2.2e-16 at most.
    EXPECT_NEAR(value.a, expected.a, 1e-15 * std::abs(expected.a));
    EXPECT_NEAR(value.v[0], expected.v[0], 1e-15 * std::abs(expected.v[0]));
    EXPECT_NEAR(value.v[1], expected.v[1], 1e-15 * std::abs(expected.v[1]));
  }
}

TEST(JetsOfPacks, HaveTheDerivativesOfJetsOfDoubles) {
  const std::array<double, 4> x{1e-20, 0.4, 7, 3e200};
  const std::array<double, 4> y{0.3, 2, 1e-9, 5};
  expect_the_jets_of_doubles([](const auto& a, const auto& b) { return log1p(a) * b; }, x, y);
  expect_the_jets_of_doubles([](const auto& a, const auto& b) { return log(a) * sqrt(b); }, x, y);
  expect_the_jets_of_doubles([](const auto& a, const auto& b) { return exp(-b) * a; }, x, y);
  expect_the_jets_of_doubles([](const auto& a, const auto& b) { return abs(-a) * b; }, x, y);
}

TEST(JetsOfPacks, HaveTheAnglesOfJetsOfDoubles) {
  const auto angle = [](const auto& a, const auto& b) { return atan2(a, b); };
  expect_the_jets_of_doubles(angle, {0.3, -0.3, 0.5, 0}, {0.2, 0.2, -7, 1});
  expect_the_jets_of_doubles(angle, {1e-20, 1, 0, -1e-9}, {1, 0, -1, 1e-9});
}

TEST(JetsOfPacks, AreChosenLaneByLaneWithTheirDerivatives) {
  const auto larger = [](const auto& a, const auto& b) { return brdf::larger(a, b); };
  expect_the_jets_of_doubles(larger, {1, 2, -1, 4}, {2, 1, -2, 5});
}

}  // namespace
}  // namespace gonio::tests
