// The derivatives that a fit sees, against differences in 50 digits.
//
// Ceres' Jets carry the derivatives through the very template that is evaluated; the reference
// evaluates the same template in 50 digits at two sides of the point. Both take the directions'
// components as they are. Formulas are checked elsewhere: here it is that the automatic derivative
// of each formula is the formula's own.
#pragma once

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>

#include "brdf/term.h"
#include "tests/reference.h"

namespace gonio::tests {

/// What a derivative may be off by, relative to it.
inline constexpr double derivative_tolerance = 1e-7;

namespace derivative_detail {

/// What rounding may leave of a derivative whose parts cancel, as a share of value / scale: 1e4
/// roundings. Where the derivative is above 1e-5 of that, it does not matter.
constexpr double cancellation = 1e-12;
/// Values beyond saturate in double and not in 50 digits; smaller ones underflow.
constexpr double largest_value = 1e250;
constexpr double smallest_value = 1e-280;

inline double to_double(const Digits& value) { return value.convert_to<double>(); }

inline brdf::Direction<Digits> in_digits(const brdf::Direction<double>& w) {
  return {exact(w.x), exact(w.y), exact(w.z)};
}

inline bool is_bound(const brdf::Parameter& parameter, double value) {
  return parameter.scale != brdf::Scale::periodic &&
         (value <= parameter.lower || value >= parameter.upper);
}

/// How much of the parameter changes a term by a good part of itself.
inline double natural_scale(const brdf::Parameter& parameter, double value) {
  switch (parameter.scale) {
    case brdf::Scale::logarithmic:
      return value;
    case brdf::Scale::logarithmic_from_one:
      return 1 + value;
    default:
      return 1;
  }
}

/// Small against the natural scale and against the distance to either bound.
inline Digits step_of(const brdf::Parameter& parameter, double value) {
  double distance = natural_scale(parameter, value);
  if ((parameter.scale == brdf::Scale::linear || parameter.scale == brdf::Scale::quadratic) &&
      !is_bound(parameter, value)) {
    distance = std::min({distance, value - parameter.lower, parameter.upper - value});
  }
  return Digits("1e-15") * distance;
}

/// The basis functions of the term T and their derivatives by the shape parameter j, in 50 digits.
template <class T>
class Differences {
 public:
  using Shape = std::array<double, T::shape.size()>;

  Differences(const Shape& shape, std::size_t j, const brdf::Direction<Digits>& wi,
              const brdf::Direction<Digits>& wo)
      : shape_(shape),
        j_(j),
        wi_(wi),
        wo_(wo),
        step_(step_of(T::shape[j], shape[j])),
        values_(basis_at(0, wi, wo)),
        derivatives_(by_difference(step_, wi, wo)) {}

  double value(std::size_t b) const { return to_double(values_[b]); }
  double derivative(std::size_t b) const { return to_double(derivatives_[b]); }
  /// With no parameter at a bound true; else whether the value is also that of double, and a step
  /// 1000 times larger tells the same derivative.
  bool has_limit(std::size_t b, double value_in_double) const {
    bool any_bound = false;
    for (std::size_t k = 0; k < shape_.size(); ++k) {
      any_bound = any_bound || is_bound(T::shape[k], shape_[k]);
    }
    if (!any_bound) return true;
    const Digits change = abs(by_difference(Digits(1000 * step_), wi_, wo_)[b] - derivatives_[b]);
    return abs(exact(value_in_double) - values_[b]) <= 1e-6 * values_[b] + smallest_value &&
           change <= 1e-9 * abs(derivatives_[b]) + cancellation * values_[b] + smallest_value;
  }

  /// How far the derivative moves when components of the directions do by a few roundings: what no
  /// evaluation that rounds a direction can avoid (the turned ones of a free frame).
  double sensitivity(std::size_t b) const {
    const Digits rounding = 4 * std::numeric_limits<double>::epsilon();
    Digits sum = 0;
    for (const auto component : {&brdf::Direction<Digits>::x, &brdf::Direction<Digits>::y}) {
      brdf::Direction<Digits> moved = wi_;
      moved.*component += rounding;
      sum += abs(by_difference(step_, moved, wo_)[b] - derivatives_[b]);
      moved = wo_;
      moved.*component += rounding;
      sum += abs(by_difference(step_, wi_, moved)[b] - derivatives_[b]);
    }
    return to_double(sum);
  }

 private:
  using Basis = std::array<Digits, brdf::basis_size<T>>;

  /// With parameter j moved by `offset`.
  Basis basis_at(const Digits& offset, const brdf::Direction<Digits>& wi,
                 const brdf::Direction<Digits>& wo) const {
    std::array<Digits, T::shape.size()> theta;
    for (std::size_t k = 0; k < theta.size(); ++k) theta[k] = exact(shape_[k]);
    theta[j_] += offset;
    return T::template basis<Digits, Digits>(theta, wi, wo);
  }

  /// To the second order of `step`: central inside the bounds, one-sided at them.
  Basis by_difference(const Digits& step, const brdf::Direction<Digits>& wi,
                      const brdf::Direction<Digits>& wo) const {
    Basis result;
    if (!is_bound(T::shape[j_], shape_[j_])) {
      const Basis above = basis_at(step, wi, wo);
      const Basis below = basis_at(-step, wi, wo);
      for (std::size_t b = 0; b < result.size(); ++b) {
        result[b] = (above[b] - below[b]) / (2 * step);
      }
      return result;
    }
    const Digits inward = shape_[j_] <= T::shape[j_].lower ? step : Digits(-step);
    const Basis here = basis_at(0, wi, wo);
    const Basis near = basis_at(inward, wi, wo);
    const Basis far = basis_at(Digits(2 * inward), wi, wo);
    for (std::size_t b = 0; b < result.size(); ++b) {
      result[b] = (4 * near[b] - 3 * here[b] - far[b]) / (2 * inward);
    }
    return result;
  }

  Shape shape_;
  std::size_t j_;
  brdf::Direction<Digits> wi_, wo_;
  Digits step_;
  Basis values_;
  Basis derivatives_;
};

/// Where a comparison was made, in words.
template <class T>
std::string place_of(const std::array<double, T::shape.size()>& shape,
                     const brdf::Direction<double>& wi, const brdf::Direction<double>& wo) {
  std::ostringstream place;
  place.precision(17);
  for (std::size_t j = 0; j < shape.size(); ++j) {
    place << "\n  " << T::shape[j].name << " = " << shape[j];
  }
  place << "\n  wi = " << wi.x << ", " << wi.y << ", " << wi.z << "\n  wo = " << wo.x << ", "
        << wo.y << ", " << wo.z;
  return place.str();
}

}  // namespace derivative_detail

/// Of one shape parameter, over the basis functions: how many derivatives were compared of values
/// that are not 0, and how many of them were so large that no error could hide in rounding.
struct ComparedDerivatives {
  int compared = 0;
  int told = 0;
};

/// Expects the derivative of every basis function of the term T by every shape parameter, as a Jet
/// has it, to be that of differences in 50 digits within derivative_tolerance. One failure lists
/// all that are not. `wi`, `wo`: unit directions. Parameters may be at their bounds; where a limit
/// is not reached in 50 digits as it is in double, or the one-sided difference has none, the Jet's
/// derivative has to be finite only.
template <class T>
std::array<ComparedDerivatives, T::shape.size()> expect_derivatives_match(
    const std::array<double, T::shape.size()>& shape, const brdf::Direction<double>& wi,
    const brdf::Direction<double>& wo) {
  using namespace derivative_detail;  // NOLINT(google-build-using-namespace)
  constexpr std::size_t count = T::shape.size();
  using Jet = ceres::Jet<double, int(count)>;
  std::array<Jet, count> theta;
  for (std::size_t j = 0; j < count; ++j) theta[j] = Jet(shape[j], int(j));
  const auto jets = T::template basis<Jet, double>(theta, wi, wo);
  const auto plain = T::template basis<double, double>(shape, wi, wo);

  std::array<ComparedDerivatives, count> result;
  std::ostringstream wrong;
  wrong.precision(17);
  for (std::size_t j = 0; j < count; ++j) {
    const Differences<T> truth(shape, j, in_digits(wi), in_digits(wo));
    const double scale = natural_scale(T::shape[j], shape[j]);
    for (std::size_t b = 0; b < jets.size(); ++b) {
      const double jet = jets[b].v[Eigen::Index(j)];
      const double value = truth.value(b);
      const double expected = truth.derivative(b);
      const double rounding = cancellation * value / scale + smallest_value;
      const double allowed = derivative_tolerance * std::abs(expected) + rounding;
      const auto report = [&](const char* what) {
        wrong << "\nderivative of " << T::description.name << ", basis function " << b << ", by "
              << T::shape[j].name << " is " << jet << ", " << what << " " << expected << " (value "
              << value << ")";
      };
      if (!std::isfinite(jet)) {
        report("not finite, expected");
        continue;
      }
      if (value > largest_value || !truth.has_limit(b, plain[b])) continue;
      const double error = std::abs(jet - expected);
      if (error > allowed && error > allowed + truth.sensitivity(b)) {
        report("expected");
        continue;
      }
      result[j].compared += value > smallest_value;
      result[j].told += std::abs(expected) > rounding / derivative_tolerance;
    }
  }
  if (!wrong.str().empty()) ADD_FAILURE() << wrong.str() << place_of<T>(shape, wi, wo);
  return result;
}

/// The same of the coefficients by the amplitudes of a channel.
template <class T>
void expect_coefficient_derivatives_match(
    const std::array<double, T::amplitudes.size()>& amplitudes) {
  constexpr std::size_t count = T::amplitudes.size();
  using Jet = ceres::Jet<double, int(count)>;
  std::array<Jet, count> given;
  for (std::size_t k = 0; k < count; ++k) given[k] = Jet(amplitudes[k], int(k));
  const auto jets = brdf::coefficients_of<T, Jet>(given);
  const Digits step("1e-15");
  for (std::size_t k = 0; k < count; ++k) {
    const auto at = [&](const Digits& offset) {
      std::array<Digits, count> moved;
      for (std::size_t l = 0; l < count; ++l) moved[l] = exact(amplitudes[l]);
      moved[k] += offset;
      return brdf::coefficients_of<T, Digits>(moved);
    };
    const auto above = at(step);
    const auto below = at(Digits(-step));
    for (std::size_t b = 0; b < jets.size(); ++b) {
      const double expected = derivative_detail::to_double((above[b] - below[b]) / (2 * step));
      EXPECT_NEAR(jets[b].v[Eigen::Index(k)], expected,
                  derivative_tolerance * std::abs(expected) + 1e-15)
          << "coefficient " << b << " of " << T::description.name << " by "
          << T::amplitudes[k].name;
    }
  }
}

}  // namespace gonio::tests
