// Every term that a model may be made of, as the types of a typed test, and random shapes for it:
// what is registered in brdf/terms.h is tested without a word more.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <tuple>
#include <type_traits>

#include "brdf/terms.h"

namespace gonio::tests {

namespace every_term_detail {

template <class... T>
testing::Types<T...> types_of(const std::tuple<T...>&);

}  // namespace every_term_detail

using EveryTerm =
    decltype(every_term_detail::types_of(std::declval<const brdf::EvaluatedTerms&>()));

/// Names a typed test by the term: `ward_aniso_free_frame`, `strauss_whole`.
struct TermNames {
  template <class T>
  static std::string GetName(int /*index*/) {  // NOLINT(readability-identifier-naming): gtest's
    std::string name(T::description.name);
    std::replace(name.begin(), name.end(), '-', '_');
    if (T::description.kind == brdf::TermKind::whole) name += "_whole";
    const bool has_angle = !T::shape.empty() && T::shape.back().name == brdf::tangent_angle.name;
    return has_angle ? name + "_free_frame" : name;
  }
};

/// Where in its bounds a parameter is. `near_*`: 1e-7 of the way to the other bound, on the scale
/// of the parameter.
enum class Place { inside, lower, near_lower, near_upper, upper };

class ShapeDraws {
 public:
  explicit ShapeDraws(std::uint64_t seed) : generator_(seed) {}

  /// A parameter with finite bounds, on its own scale.
  double draw(const brdf::Parameter& parameter, Place place) {
    if (place == Place::lower) return parameter.lower;
    if (place == Place::upper) return parameter.upper;
    const double share = place == Place::near_lower ? 1e-7
                         : place == Place::near_upper
                             ? 1 - 1e-7
                             : std::uniform_real_distribution()(generator_);
    const double low = parameter.lower;
    const double high = parameter.upper;
    switch (parameter.scale) {
      case brdf::Scale::logarithmic:
        return std::clamp(low * std::pow(high / low, share), low, high);
      case brdf::Scale::logarithmic_from_one:
        return std::clamp(
            std::expm1(std::log1p(low) + share * (std::log1p(high) - std::log1p(low))), low, high);
      default:
        return low + share * (high - low);
    }
  }

  /// All parameters inside; but that with the index `edge`, if there is one, at `place`.
  template <class T>
  std::array<double, T::shape.size()> draw(std::size_t edge = T::shape.size(),
                                           Place place = Place::inside) {
    std::array<double, T::shape.size()> shape{};
    for (std::size_t j = 0; j < shape.size(); ++j) {
      shape[j] = draw(T::shape[j], j == edge ? place : Place::inside);
    }
    return shape;
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace gonio::tests
