// Least squares in a box: Levenberg and Marquardt's steps, each bent along the bounds that it
// meets.
//
// Where several bounds hold at the solution, as they do when a renderer's material cannot follow
// ours, a step that is cut off at the bounds afterwards may go uphill however short it is, and a
// solver that does so (Ceres 2.1) stops there. Here what is at a bound stays there while the others
// are solved for (an active set: Nocedal & Wright, Numerical Optimization, section 16.7).
#pragma once

#include <Eigen/Core>
#include <functional>

namespace gonio::exports {

/// A sum of squares |r(x)|^2 / 2 near some x, r linearised.
struct Quadratic {
  double cost;               // |r|^2 / 2
  Eigen::VectorXd gradient;  // J^T r
  Eigen::MatrixXd hessian;   // J^T J
};

struct BoxProblem {
  Eigen::VectorXd lower, upper;
  std::function<double(const Eigen::VectorXd&)> cost;
  std::function<Quadratic(const Eigen::VectorXd&)> linearised;
};

struct Effort {
  int iterations;
  /// Ends where a step lowers the cost by less than this share of it,
  double cost_tolerance;
  /// or changes every unknown by less than this share of the box (of 1 where that is smaller).
  double step_tolerance;
};

struct BoxMinimum {
  Eigen::VectorXd x;
  double cost;
};

/// A local minimum from `start`, which lies in the box; never above the cost there.
BoxMinimum box_minimum(const BoxProblem& problem, const Eigen::VectorXd& start,
                       const Effort& effort);

}  // namespace gonio::exports
