// No NaN, no infinity, no negative value: the Ward family where numbers run out of range.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "brdf/model.h"
#include "tests/ward_reference.h"

namespace gonio::tests {
namespace {

using brdf::Direction;

/// Unit to rounding, with exactly this cosine.
template <class D>
Direction<D> with_cosine(D cosine, D phi) {
  const D sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

/// From the pole to the horizon, every order of magnitude down to the smallest denormal.
template <class D>
std::vector<D> stratified_cosines() {
  std::vector<D> cosines{1,
                         D(0.7),
                         D(0.1),
                         std::abs(std::cos(std::numbers::pi_v<D> / 2)),
                         std::numeric_limits<D>::min(),
                         std::numeric_limits<D>::denorm_min()};
  for (D c = D(0.01); c > 0; c /= D(30)) cosines.push_back(c);
  return cosines;
}

template <class D>
std::vector<Direction<D>> extreme_directions() {
  std::vector<Direction<D>> directions;
  for (const D cosine : stratified_cosines<D>()) {
    directions.push_back({std::sqrt(1 - cosine * cosine), 0, cosine});
    directions.push_back({-std::sqrt(1 - cosine * cosine), 0, cosine});  // antiparallel
    directions.push_back(with_cosine(cosine, D(2)));
  }
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<D> log_cosine(std::log10(std::numeric_limits<D>::min()), 0);
  std::uniform_real_distribution<D> phi(0, 2 * std::numbers::pi_v<D>);
  for (int i = 0; i < 60; ++i) {
    const D cosine = std::pow(D(10), log_cosine(generator));
    directions.push_back(with_cosine(cosine, phi(generator)));
  }
  return directions;
}

template <class D>
std::vector<std::pair<D, D>> extreme_roughnesses() {
  return {{D(1e-4), D(1e-4)}, {D(1e-4), D(10)},  {D(10), D(1e-4)},
          {D(10), D(10)},     {D(0.03), D(0.3)}, {D(1), D(1)}};
}

template <class D, class Lobe>
void expect_sane() {
  const auto directions = extreme_directions<D>();
  for (const auto& [ax, ay] : extreme_roughnesses<D>()) {
    for (const auto& wi : directions) {
      for (const auto& wo : directions) {
        const D value = brdf::AnisotropicWard<Lobe>::template basis<D, D>({ax, ay}, wi, wo)[0];
        ASSERT_TRUE(std::isfinite(value) && value >= 0)
            << value << " at cosines " << wi.z << ", " << wo.z << ", alpha " << ax << ", " << ay;
      }
    }
  }
}

/// The value that the type can hold: saturated, or 0 where it underflows.
template <class D, class Lobe>
void expect_right() {
  constexpr D largest = std::numeric_limits<D>::max();
  const auto directions = extreme_directions<D>();
  for (const auto& [ax, ay] : extreme_roughnesses<D>()) {
    for (std::size_t i = 0; i < directions.size(); i += 5) {
      for (std::size_t k = 0; k < directions.size(); k += 7) {
        const auto& wi = directions[i];
        const auto& wo = directions[k];
        const ReferenceValue truth = reference(Lobe{}, Digits(ax), Digits(ay), wi, wo);
        if (truth.exponent > 27) continue;  // dark: ward_test looks at it
        const Digits expected = truth.value < largest ? truth.value : Digits(largest);
        const D value = brdf::AnisotropicWard<Lobe>::template basis<D, D>({ax, ay}, wi, wo)[0];
        // Near the largest number the denominator of a rough lobe is denormal and has 13 bits.
        const double tolerance =
            truth.value > largest / 1e5 ? 1e-3 : 200 * double{std::numeric_limits<D>::epsilon()};
        ASSERT_LE(abs(exact(value) - expected), tolerance * expected)
            << value << " instead of " << expected.template convert_to<double>() << " at cosines "
            << wi.z << ", " << wo.z << ", alpha " << ax << ", " << ay;
      }
    }
  }
}

template <class Lobe>
class WardExtremes : public testing::Test {};
using Lobes =
    testing::Types<brdf::WardLobe, brdf::WardApproxLobe, brdf::WardDuerLobe, brdf::WardGmdLobe>;
TYPED_TEST_SUITE(WardExtremes, Lobes);

TYPED_TEST(WardExtremes, DoubleIsFiniteAndNotNegative) { expect_sane<double, TypeParam>(); }
TYPED_TEST(WardExtremes, FloatIsFiniteAndNotNegative) { expect_sane<float, TypeParam>(); }
TYPED_TEST(WardExtremes, DoubleIsRightOrSaturated) { expect_right<double, TypeParam>(); }
TYPED_TEST(WardExtremes, FloatIsRightOrSaturated) { expect_right<float, TypeParam>(); }

TEST(ModelExtremes, EveryModelSaturatesInsteadOfOverflowing) {
  const auto directions = extreme_directions<double>();
  for (const std::string& name : brdf::model_names()) {
    SCOPED_TRACE(name);
    const brdf::Model model(name);
    std::vector<double> amplitudes;
    for (const auto& p : model.amplitudes()) {
      amplitudes.push_back(std::min(1e300, p.descriptor.upper));
    }
    for (const bool upper : {false, true}) {
      std::vector<double> shape;
      for (const auto& p : model.shape()) {
        shape.push_back(upper ? p.descriptor.upper : p.descriptor.lower);
      }
      for (const auto& wi : directions) {
        for (const auto& wo : directions) {
          const double value = model.evaluate(amplitudes, shape, wi, wo);
          ASSERT_TRUE(std::isfinite(value) && value >= 0) << value;
        }
      }
    }
  }
}

}  // namespace
}  // namespace gonio::tests
