// Packs of four doubles: the functions against the long double ones of the C library, in the copy
// for any CPU and in the copy for this one; and the batches of a model's terms that are made of
// packs against the terms evaluated one pair of directions at a time.
#include "brdf/pack.h"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "brdf/model.h"
#include "brdf/terms.h"
#include "fit/batch_model.h"

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

// The batches.

/// Directions all over the sphere of `count` pairs: every other half vector near the normal, within
/// most lobes, some directions below the horizon, some grazing.
fit::DirectionChunk directions(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  fit::DirectionChunk chunk;
  chunk.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    const double theta_i = draw(0, i % 8 == 5 ? 120 : 89.9);
    const double phi_i = draw(-180, 180);
    const bool near_mirror = i % 2 == 0;
    const auto wi = brdf::direction_from_degrees(theta_i, phi_i);
    const auto wo =
        near_mirror ? brdf::direction_from_degrees(theta_i + draw(-8, 8), phi_i + 180 + draw(-8, 8))
                    : brdf::direction_from_degrees(draw(0, 95), draw(-180, 180));
    chunk.wi_x[i] = wi.x;
    chunk.wi_y[i] = wi.y;
    chunk.wi_z[i] = wi.z;
    chunk.wo_x[i] = wo.x;
    chunk.wo_y[i] = wo.y;
    chunk.wo_z[i] = wo.z;
  }
  chunk.pad();
  return chunk;
}

brdf::Direction<double> wi_of(const fit::DirectionChunk& chunk, std::size_t i) {
  return {chunk.wi_x[i], chunk.wi_y[i], chunk.wi_z[i]};
}
brdf::Direction<double> wo_of(const fit::DirectionChunk& chunk, std::size_t i) {
  return {chunk.wo_x[i], chunk.wo_y[i], chunk.wo_z[i]};
}

/// The derivatives of a model's basis by its shape, [amplitude][shape], by scalar Jets.
using JetTable = std::vector<std::vector<double>>;

template <class T>
void add_jets(const brdf::Model& model, std::size_t term, std::size_t& amplitude,
              std::size_t& shape_index, const std::vector<double>& shape,
              const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
              JetTable& derivatives) {
  constexpr std::size_t shape_count = T::shape.size();
  if constexpr (shape_count > 0) {
    using Jet = ceres::Jet<double, int(shape_count)>;
    std::array<Jet, shape_count> theta;
    for (std::size_t j = 0; j < shape_count; ++j) theta[j] = Jet(shape[shape_index + j], int(j));
    const auto basis = T::template basis<Jet, double>(theta, wi, wo);
    for (std::size_t k = 0; k < basis.size(); ++k) {
      for (std::size_t j = 0; j < shape_count; ++j) {
        derivatives[amplitude + k][shape_index + j] = basis[k].v[Eigen::Index(j)];
      }
    }
  }
  amplitude += model.terms()[term]->amplitudes.size();
  shape_index += shape_count;
}

template <std::size_t... I>
JetTable jets_of(const brdf::Model& model, const std::vector<double>& shape,
                 const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                 std::index_sequence<I...> /*terms*/) {
  JetTable derivatives(model.amplitudes().size(), std::vector<double>(shape.size()));
  std::size_t amplitude = 0;
  std::size_t shape_index = 0;
  for (std::size_t t = 0; t < model.terms().size(); ++t) {
    const std::size_t index = model.terms()[t]->index;
    ((index == I ? add_jets<std::tuple_element_t<I, brdf::EvaluatedTerms>>(
                       model, t, amplitude, shape_index, shape, wi, wo, derivatives)
                 : void()),
     ...);
  }
  return derivatives;
}

/// A shape inside the search ranges, different for each parameter.
std::vector<double> some_shape(const brdf::Model& model) {
  std::vector<double> shape;
  for (const brdf::ModelParameter& parameter : model.shape()) {
    const bool is_angle = parameter.descriptor.scale == brdf::Scale::periodic;
    shape.push_back(is_angle ? 0.4 : 0.09 * std::pow(1.7, double(shape.size())));
  }
  return shape;
}

class BatchOf : public testing::TestWithParam<std::pair<const char*, brdf::Frame>> {
 protected:
  // An exponent of up to 27.6 and the slopes in it err by some 1e-15 each, the value by that share.
  static constexpr double rounding = 1e-12;
  static constexpr double dark = 1e-12;  // exp(-27.6)

  static void compare(const brdf::Model& model, const std::vector<double>& shape,
                      const fit::DirectionChunk& chunk, const Eigen::MatrixXd& columns,
                      int& compared) {
    const fit::BatchModel batch(model);
    for (std::size_t i = 0; i < chunk.count; ++i) {
      const auto row = Eigen::Index(i);
      std::vector<double> basis(model.amplitudes().size());
      model.basis(shape, wi_of(chunk, i), wo_of(chunk, i), basis);
      const JetTable jets =
          jets_of(model, shape, wi_of(chunk, i), wo_of(chunk, i),
                  std::make_index_sequence<std::tuple_size_v<brdf::EvaluatedTerms>>());
      for (std::size_t k = 0; k < basis.size(); ++k) {
        const double value = columns(row, Eigen::Index(k));
        ASSERT_NEAR(value, basis[k], rounding * basis[k] + dark * dark);
        ASSERT_TRUE(value == 0 || (chunk.wi_z[i] > 0 && chunk.wo_z[i] > 0)) << "below the horizon";
      }
      for (std::size_t d = 0; d < batch.derivatives().size(); ++d) {
        const auto [amplitude, j] = batch.derivatives()[d];
        // The parts of a derivative, 2 * 27.6 / alpha times the value, may cancel: rounding is held
        // to their size; psi turns alpha_x / alpha_y + alpha_y / alpha_x < 4 times the exponent.
        const bool is_angle = model.shape()[j].descriptor.scale == brdf::Scale::periodic;
        const double scale = basis[amplitude] * 60 * (is_angle ? 4 : 1 / shape[j]);
        const double expected = jets[amplitude][j];
        if (basis[amplitude] < dark) {
          ASSERT_TRUE(std::isfinite(columns(row, Eigen::Index(basis.size() + d))));
          continue;
        }
        ASSERT_NEAR(columns(row, Eigen::Index(basis.size() + d)), expected, rounding * scale);
        ++compared;
      }
    }
  }
};

TEST_P(BatchOf, HoldsTheTermsAndTheirDerivativesWhateverItsLength) {
  const brdf::Model model(GetParam().first, GetParam().second);
  const fit::BatchModel batch(model);
  const std::vector<double> shape = some_shape(model);
  int compared = 0;
  for (const std::size_t count : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 511U, 512U}) {
    const fit::DirectionChunk chunk = directions(count, count);
    Eigen::MatrixXd columns = Eigen::MatrixXd::Constant(
        fit::column_stride, Eigen::Index(batch.column_count(true)), std::nan(""));
    batch.evaluate(chunk, shape, true, columns);
    compare(model, shape, chunk, columns, compared);
    // Padding is evaluated as well, so that nobody reads what nobody wrote; nothing is beyond it.
    const auto padded = Eigen::Index((count + 3) / 4 * 4);
    EXPECT_TRUE(columns.topRows(padded).allFinite()) << count;
    EXPECT_TRUE(columns.bottomRows(fit::column_stride - padded).array().isNaN().all()) << count;

    Eigen::MatrixXd values_only(fit::column_stride, Eigen::Index(batch.column_count(false)));
    batch.evaluate(chunk, shape, false, values_only);
    for (Eigen::Index k = 0; k < values_only.cols(); ++k) {
      for (Eigen::Index i = 0; i < Eigen::Index(count); ++i) {
        // Jets divide by way of the reciprocal: an exponent of up to 745 is another by 3e-16 of it.
        EXPECT_NEAR(values_only(i, k), columns(i, k), rounding * values_only(i, k) + dark * dark);
      }
    }
  }
  EXPECT_GT(compared, shape.empty() ? -1 : 300) << "the directions miss the lobe";
}

TEST_P(BatchOf, IsFiniteAtTheExtremes) {
  const brdf::Model model(GetParam().first, GetParam().second);
  const fit::BatchModel batch(model);
  fit::DirectionChunk chunk = directions(8, 1);
  const std::array<double, 8> cosines{1, 1e-3, 1e-10, 1e-160, 5e-324, 0, -1e-3, -1};
  for (const double cos_o : cosines) {
    for (std::size_t i = 0; i < cosines.size(); ++i) {
      chunk.wi_x[i] = std::sqrt(1 - cosines[i] * cosines[i]);
      chunk.wi_y[i] = 0;
      chunk.wi_z[i] = cosines[i];
      chunk.wo_x[i] = -std::sqrt(1 - cos_o * cos_o);
      chunk.wo_y[i] = 0;
      chunk.wo_z[i] = cos_o;
    }
    for (const double alpha : {1e-4, 10.0}) {
      std::vector<double> shape = some_shape(model);
      for (std::size_t j = 0; j < shape.size(); ++j) {
        if (model.shape()[j].descriptor.scale == brdf::Scale::logarithmic) shape[j] = alpha;
      }
      Eigen::MatrixXd columns(fit::column_stride, Eigen::Index(batch.column_count(false)));
      batch.evaluate(chunk, shape, false, columns);
      EXPECT_TRUE(columns.topRows(8).allFinite()) << cos_o << " alpha " << alpha;
      EXPECT_TRUE((columns.topRows(8).array() >= 0).all()) << cos_o << " alpha " << alpha;
      EXPECT_TRUE((columns.middleRows(5, 3).array() == 0).all()) << "below the horizon";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EveryTerm, BatchOf,
                         testing::Values(std::pair("lambert", brdf::Frame::of_table),
                                         std::pair("ward", brdf::Frame::of_table),
                                         std::pair("ward-aniso", brdf::Frame::of_table),
                                         std::pair("ward-approx", brdf::Frame::of_table),
                                         std::pair("ward-approx-aniso", brdf::Frame::of_table),
                                         std::pair("ward-duer", brdf::Frame::of_table),
                                         std::pair("ward-duer-aniso", brdf::Frame::of_table),
                                         std::pair("ward-gmd", brdf::Frame::of_table),
                                         std::pair("ward-gmd-aniso", brdf::Frame::of_table),
                                         std::pair("ward-aniso", brdf::Frame::free),
                                         std::pair("ward-approx-aniso", brdf::Frame::free),
                                         std::pair("ward-duer-aniso", brdf::Frame::free),
                                         std::pair("ward-gmd-aniso", brdf::Frame::free),
                                         std::pair("lambert+ward+ward-gmd-aniso",
                                                   brdf::Frame::free)),
                         [](const auto& instance) {
                           std::string name = instance.param.first;
                           for (char& c : name) {
                             if (c == '-' || c == '+') c = '_';
                           }
                           return name +
                                  (instance.param.second == brdf::Frame::free ? "_free" : "");
                         });

}  // namespace
}  // namespace gonio::tests
