// Nelder and Mead's (1965) simplex: a minimiser that looks at nothing but the function's values.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

namespace gonio::tests {

struct LowestPoint {
  Eigen::VectorXd x;
  double value;
};

/// The lowest point that the simplex finds with about so many looks at the function; its corners
/// are `start` and a step along each axis.
template <class Function>
LowestPoint nelder_mead(const Function& function, const Eigen::VectorXd& start,
                        const Eigen::VectorXd& steps, int most_values) {
  std::vector<LowestPoint> corners{{start, function(start)}};
  for (Eigen::Index k = 0; k < start.size(); ++k) {
    Eigen::VectorXd x = start;
    x[k] += steps[k];
    corners.push_back({x, function(x)});
  }
  const auto is_lower = [](const LowestPoint& a, const LowestPoint& b) {
    return a.value < b.value;
  };
  for (int values = int(corners.size()); values < most_values;) {
    std::sort(corners.begin(), corners.end(), is_lower);
    LowestPoint& worst = corners.back();
    Eigen::VectorXd centre = Eigen::VectorXd::Zero(start.size());
    for (const LowestPoint& corner : corners) centre += corner.x;
    centre = (centre - worst.x) / double(start.size());
    const auto beyond = [&](double factor) {
      Eigen::VectorXd x = centre + factor * (centre - worst.x);
      ++values;
      const double value = function(x);
      return LowestPoint{std::move(x), value};
    };
    LowestPoint next = beyond(1);
    if (is_lower(next, corners.front())) {
      LowestPoint further = beyond(2);
      if (is_lower(further, next)) next = std::move(further);
    } else if (!is_lower(next, corners[corners.size() - 2])) {
      next = beyond(is_lower(next, worst) ? 0.5 : -0.5);
    }
    if (is_lower(next, worst)) {
      worst = std::move(next);
      continue;
    }
    for (std::size_t k = 1; k < corners.size(); ++k) {
      corners[k].x = (corners[k].x + corners.front().x) / 2;
      corners[k].value = function(corners[k].x);
      ++values;
    }
  }
  return *std::min_element(corners.begin(), corners.end(), is_lower);
}

}  // namespace gonio::tests
