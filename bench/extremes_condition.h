// Where a formula cannot be evaluated to the promised digits because its value follows the last
// digits of the directions: by how much it may err there, derived term by term.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>

#include "brdf/terms.h"

namespace gonio::bench {

/// A bound on the relative error of the term T, in a precision of the given epsilon, for inputs
/// that may need one beyond the project's figure; 0 for all others. By default no input does.
template <class T>
struct Condition {
  static constexpr std::string_view derivation{};
  template <std::size_t P>
  static double bound(const std::array<double, P>& /*shape*/, const brdf::Direction<double>& /*wi*/,
                      const brdf::Direction<double>& /*wo*/, double /*epsilon*/) {
    return 0;
  }
};

namespace condition_detail {

/// Of (r.wo)^n. Where r.wo is below 1/2 it is the sum of three products whose sizes add up to at
/// most 1: the roundings of the products and of two sums are at most 4 half-epsilons, whatever r.wo
/// is. Where that is as much as r.wo itself, its very sign is unknown.
inline double of_mirror_lobe(double exponent, const brdf::Direction<double>& wi,
                             const brdf::Direction<double>& wo, double epsilon) {
  using Wide = long double;  // double itself would not know the cosine any better
  const double cosine = double(Wide(wi.z) * wo.z - Wide(wi.x) * wo.x - Wide(wi.y) * wo.y);
  if (cosine >= 0.5) return 0;
  const double share = 2 * epsilon / std::abs(cosine);
  if (!(share < 1)) return std::numeric_limits<double>::infinity();
  return std::max(std::expm1(exponent * std::log1p(share)),
                  -std::expm1(exponent * std::log1p(-share)));
}

inline constexpr std::string_view mirror_lobe_derivation =
    "where r.wo < 1/2, at most (1 + 2 epsilon / (r.wo))^n - 1: r.wo is a sum of products that "
    "nearly cancel";

}  // namespace condition_detail

template <>
struct Condition<brdf::Phong> {
  static constexpr std::string_view derivation = condition_detail::mirror_lobe_derivation;
  static double bound(const std::array<double, 1>& shape, const brdf::Direction<double>& wi,
                      const brdf::Direction<double>& wo, double epsilon) {
    return condition_detail::of_mirror_lobe(shape[0], wi, wo, epsilon);
  }
};

/// The lobe is at most the whole of f_r. Its exponent is 3/(1 - s); at s = 1 it is dark off the
/// mirror direction.
template <class ArgumentOf>
struct Condition<brdf::StraussTerm<ArgumentOf>> {
  static constexpr std::string_view derivation = condition_detail::mirror_lobe_derivation;
  static double bound(const std::array<double, 3>& shape, const brdf::Direction<double>& wi,
                      const brdf::Direction<double>& wo, double epsilon) {
    const double rest = 1 - shape[0];
    return rest > 0 ? condition_detail::of_mirror_lobe(3 / rest, wi, wo, epsilon) : 0;
  }
};

}  // namespace gonio::bench
