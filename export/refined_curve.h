// Values over an angle, at as many angles as straight lines between them need.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace gonio::exports {

using Values = std::vector<double>;

/// The nearest multiple of 1e-6 rad, to which formats show angles.
inline double rounded_angle(double angle) {
  constexpr double step = 1e-6;
  return std::round(angle / step) * step;
}

/// An ordered set of angles with the values there, to be refined until straight lines between them
/// are near enough to the function.
struct Curve {
  std::vector<double> angles;
  std::vector<Values> values;
};

/// How far a straight line may lie from a function, per value of it: `error` between nodes that are
/// up to `width` apart. Beyond, as much less as its square is more, or the errors in the foot of a
/// narrow lobe would add up to more light than the lobe holds.
struct Allowance {
  Values error;
  Values width;
};

/// Whether the values a share `at` of the way from a to b are near those of the straight line.
inline bool is_straight(const Values& a, const Values& b, double at, const Values& between,
                        const Allowance& allowed, double distance) {
  for (std::size_t v = 0; v < between.size(); ++v) {
    const double share = std::min(1.0, allowed.width[v] / distance);
    const double error = std::abs((1 - at) * a[v] + at * b[v] - between[v]);
    if (error > allowed.error[v] * share * share) return false;
  }
  return true;
}

/// Appends the nodes between a (exclusive) and b (inclusive). A middle and a quarter are looked at:
/// where a curve bends both ways, its middle may lie on the line.
template <class Function>
void refine(const Function& function, double a, const Values& at_a, double b, const Values& at_b,
            const Allowance& allowed, Curve& curve) {
  const double middle = rounded_angle((a + b) / 2);
  if (middle > a && middle < b) {
    const Values at_middle = function(middle);
    const double quarter = (3 * a + b) / 4;
    if (!is_straight(at_a, at_b, (middle - a) / (b - a), at_middle, allowed, b - a) ||
        !is_straight(at_a, at_b, 0.25, function(quarter), allowed, b - a)) {
      refine(function, a, at_a, middle, at_middle, allowed, curve);
      refine(function, middle, at_middle, b, at_b, allowed, curve);
      return;
    }
  }
  curve.angles.push_back(b);
  curve.values.push_back(at_b);
}

/// The function at the ascending angles `start` and at what has to be between them.
template <class Function>
Curve refined(const Function& function, std::span<const double> start, const Allowance& allowed) {
  Curve curve{{start.front()}, {function(start.front())}};
  for (std::size_t i = 1; i < start.size(); ++i) {
    const double a = curve.angles.back();
    const Values at_a = curve.values.back();
    refine(function, a, at_a, start[i], function(start[i]), allowed, curve);
  }
  return curve;
}

}  // namespace gonio::exports
