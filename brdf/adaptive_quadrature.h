// Adaptive quadrature of several functions of one variable at once, which share their evaluations.
//
// Each interval is integrated by Kronrod's 15 points, and the 7 of them that are Gauss's give a
// second value (Kronrod 1965; Piessens et al., QUADPACK, 1983). The difference is taken for the
// error: it is that of the 7 points, an upper estimate where the functions are smooth. The interval
// with the largest share of the allowed error is halved until the errors of all intervals together
// are within it, for each function. What halving changes counts as error as well: it tells where
// the functions are not smooth.
#pragma once

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace gonio::brdf {

/// Per function: the integral and an upper estimate of its error.
struct Integrals {
  std::vector<double> values;
  std::vector<double> errors;
};

/// When to stop: the error of each function is at most the larger of `relative` times its integral
/// and its entry of `absolute` (which may be empty: all 0), or there are `most_intervals`.
struct QuadratureGoal {
  double relative;
  std::span<const double> absolute;
  std::size_t most_intervals;
};

namespace quadrature_detail {

struct Interval {
  double lower, upper;
  std::vector<double> values;
  std::vector<double> errors;
};

/// `function(x, results)` writes `count` values.
template <class Function>
Interval integrated(Function& function, std::size_t count, double lower, double upper) {
  using Kronrod = boost::math::quadrature::gauss_kronrod<double, 15>;
  using Gauss = boost::math::quadrature::gauss<double, 7>;
  // Both hold the centre and the points to its right; Gauss's are every second one.
  const auto& points = Kronrod::abscissa();
  const double centre = (lower + upper) / 2;
  const double half_width = (upper - lower) / 2;
  Interval interval{lower, upper, std::vector<double>(count), std::vector<double>(count)};
  std::vector<double> results(count);
  const auto add = [&](std::size_t k, double x) {
    function(x, std::span<double>(results));
    const double kronrod = half_width * Kronrod::weights()[k];
    const double gauss = k % 2 == 0 ? half_width * Gauss::weights()[k / 2] : 0;
    for (std::size_t i = 0; i < count; ++i) {
      interval.values[i] += kronrod * results[i];
      interval.errors[i] += (kronrod - gauss) * results[i];
    }
  };
  add(0, centre);
  for (std::size_t k = 1; k < points.size(); ++k) {
    add(k, centre - half_width * points[k]);
    add(k, centre + half_width * points[k]);
  }
  for (double& error : interval.errors) error = std::abs(error);
  return interval;
}

inline Integrals sum_of(const std::vector<Interval>& intervals, std::size_t count) {
  Integrals sum{std::vector<double>(count), std::vector<double>(count)};
  for (const Interval& interval : intervals) {
    for (std::size_t i = 0; i < count; ++i) {
      sum.values[i] += interval.values[i];
      sum.errors[i] += interval.errors[i];
    }
  }
  return sum;
}

/// Halving an interval shows what its error was. Where the function jumps, that of the halves is
/// about half of it, and both rules may err alike.
inline void doubt_if_changed(const std::vector<double>& before, Interval& left, Interval& right) {
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double change = std::abs(left.values[i] + right.values[i] - before[i]);
    left.errors[i] = std::max(left.errors[i], change / 4);
    right.errors[i] = std::max(right.errors[i], change / 4);
  }
}

/// Per function, 1 over the allowed error; 0 for one that is within it.
inline std::vector<double> urgency(const Integrals& sum, const QuadratureGoal& goal) {
  std::vector<double> result(sum.values.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double absolute = goal.absolute.empty() ? 0 : goal.absolute[i];
    const double allowed = std::max(goal.relative * std::abs(sum.values[i]), absolute);
    if (sum.errors[i] > allowed) result[i] = 1 / std::max(allowed, 1e-300);
  }
  return result;
}

/// The interval to halve next; the number of intervals if none is to be, or none can be.
inline std::size_t worst_of(const std::vector<Interval>& intervals,
                            const std::vector<double>& urgency) {
  // Halving further would only integrate rounding.
  constexpr double narrowest = 1e-13;
  std::size_t worst = intervals.size();
  double largest = 0;
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    const Interval& interval = intervals[k];
    const double size = std::max(std::abs(interval.lower), std::abs(interval.upper));
    if (interval.upper - interval.lower <= narrowest * size) continue;
    for (std::size_t i = 0; i < urgency.size(); ++i) {
      const double error = interval.errors[i] * urgency[i];
      if (!(error > largest)) continue;
      largest = error;
      worst = k;
    }
  }
  return worst;
}

}  // namespace quadrature_detail

/// The integrals of `count` functions from the first to the last of the increasing `breaks`, where
/// narrow features or kinks should lie. `function(x, results)` writes the values at x to the span
/// `results`. Whether the goal was reached is told by the errors.
template <class Function>
Integrals integrate(Function function, std::size_t count, std::span<const double> breaks,
                    const QuadratureGoal& goal) {
  std::vector<quadrature_detail::Interval> intervals;
  for (std::size_t k = 1; k < breaks.size(); ++k) {
    intervals.push_back(quadrature_detail::integrated(function, count, breaks[k - 1], breaks[k]));
  }
  for (;;) {
    Integrals sum = quadrature_detail::sum_of(intervals, count);
    const std::size_t worst =
        quadrature_detail::worst_of(intervals, quadrature_detail::urgency(sum, goal));
    if (worst == intervals.size() || intervals.size() >= goal.most_intervals) return sum;
    const double lower = intervals[worst].lower;
    const double upper = intervals[worst].upper;
    const double middle = (lower + upper) / 2;
    const std::vector<double> before = std::move(intervals[worst].values);
    intervals[worst] = quadrature_detail::integrated(function, count, lower, middle);
    intervals.push_back(quadrature_detail::integrated(function, count, middle, upper));
    quadrature_detail::doubt_if_changed(before, intervals[worst], intervals.back());
  }
}

}  // namespace gonio::brdf
