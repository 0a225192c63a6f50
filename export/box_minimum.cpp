#include "export/box_minimum.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

namespace gonio::exports {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The steps that lead just to the bounds.
struct Room {
  VectorXd down, up;
};

/// The minimum of the damped quadratic over the unknowns that are free, the step of the others
/// given.
void solve_free(const Quadratic& quadratic, const VectorXd& damping, const std::vector<Index>& free,
                VectorXd& step) {
  VectorXd held = step;
  held(free).setZero();
  const VectorXd slope = quadratic.gradient + quadratic.hessian * held;
  Eigen::MatrixXd matrix = quadratic.hessian(free, free);
  matrix.diagonal() += damping(free);
  const VectorXd rhs = -slope(free);
  const VectorXd solution = matrix.ldlt().solve(rhs);
  step(free) = solution;
}

/// A step within the room. Unknowns at a bound that the slope presses on stay there from the
/// beginning; each that a solution takes beyond a bound is put on it and the others solved again.
VectorXd bent_step(const Quadratic& quadratic, const VectorXd& damping, const Room& room) {
  VectorXd step = VectorXd::Zero(quadratic.gradient.size());
  std::vector<Index> free;
  for (Index i = 0; i < step.size(); ++i) {
    const bool pressed = (quadratic.gradient[i] > 0 && room.down[i] >= 0) ||
                         (quadratic.gradient[i] < 0 && room.up[i] <= 0);
    if (!pressed) free.push_back(i);
  }
  while (!free.empty()) {
    solve_free(quadratic, damping, free, step);
    std::vector<Index> inside;
    for (const Index i : free) {
      if (step[i] > room.down[i] && step[i] < room.up[i]) {
        inside.push_back(i);
      } else {
        step[i] = std::clamp(step[i], room.down[i], room.up[i]);
      }
    }
    if (inside.size() == free.size()) break;
    free = std::move(inside);
  }
  return step;
}

bool is_short(const VectorXd& step, const BoxProblem& problem, double tolerance) {
  for (Index i = 0; i < step.size(); ++i) {
    const double width = std::min(1.0, problem.upper[i] - problem.lower[i]);
    if (std::abs(step[i]) > tolerance * width) return false;
  }
  return true;
}

}  // namespace

BoxMinimum box_minimum(const BoxProblem& problem, const VectorXd& start, const Effort& effort) {
  constexpr double most_damping = 1e12;
  BoxMinimum best{start, 0};
  Quadratic quadratic = problem.linearised(best.x);
  best.cost = quadratic.cost;
  double damping = 1e-3;
  for (int iteration = 0; iteration < effort.iterations && damping < most_damping; ++iteration) {
    // Of the diagonal, so that no unit matters; a little of the largest for an unknown that nothing
    // depends on here.
    const VectorXd diagonal = quadratic.hessian.diagonal();
    const VectorXd damped = damping * (diagonal.array() + 1e-9 * diagonal.maxCoeff()).matrix();
    const VectorXd step =
        bent_step(quadratic, damped, {problem.lower - best.x, problem.upper - best.x});
    const VectorXd trial = (best.x + step).cwiseMax(problem.lower).cwiseMin(problem.upper);
    const double cost = problem.cost(trial);
    const bool short_step = is_short(step, problem, effort.step_tolerance);
    if (cost < best.cost) {
      const bool settled = best.cost - cost < effort.cost_tolerance * best.cost;
      best = {trial, cost};
      if (settled || short_step) break;
      quadratic = problem.linearised(best.x);
      damping = std::max(damping / 8, 1e-15);
    } else {
      if (short_step) break;
      damping *= 4;
    }
  }
  return best;
}

}  // namespace gonio::exports
