#include "fit/channel_amplitudes.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "fit/bounded_least_squares.h"

namespace gonio::fit {
namespace {

/// Gauss and Newton's steps are quadratic where the coefficients reach the data, as
/// Ashikhmin-Shirley's do; for Oren-Nayar's rho^2 they shrink by a factor.
constexpr int most_iterations = 60;
constexpr int most_halvings = 30;
/// Squares that differ by less are the same but for rounding.
constexpr double same_square = 1e-13;

struct Point {
  Eigen::VectorXd free;
  double square;
};

bool is_same(const Point& a, const Point& b) {
  return std::abs(a.square - b.square) <= same_square * b.square;
}

/// A step of Gauss and Newton.
struct Step {
  Eigen::VectorXd from, to;

  double size() const { return (to - from).norm(); }
};

/// Where the model is far from the data the steps shrink by a constant factor, or overshoot by one.
/// The secant through the last two says how much of a step leads to the end.
double secant_length(const Step& last, const Step& step) {
  const Eigen::VectorXd moved = step.from - last.from;
  const double bend = moved.dot((last.to - last.from) - (step.to - step.from));
  return bend > 0 ? moved.squaredNorm() / bend : 1;
}

class NonlinearProblem {
 public:
  NonlinearProblem(const BatchModel& model, const FreeAmplitudes& amplitudes,
                   const Eigen::MatrixXd& basis, const Eigen::VectorXd& values)
      : model_(model), amplitudes_(amplitudes), basis_(basis), values_(values) {
    if (basis.rows() <= basis.cols()) return;
    // The same problem in as many rows as columns: it is looked at many times.
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(basis);
    const Eigen::VectorXd turned = qr.householderQ().adjoint() * values;
    basis_ = qr.matrixQR().topRows(basis.cols()).triangularView<Eigen::Upper>();
    values_ = turned.head(basis.cols());
  }

  Point at(Eigen::VectorXd free) const {
    const double square = residuals(free).squaredNorm();
    return {std::move(free), square};
  }

  /// The nearest to 0.
  Eigen::VectorXd nearest() const {
    return within_bounds(Eigen::VectorXd::Zero(amplitudes_.lower.size()));
  }

  /// At the upper bounds. An amplitude without one is so large that the model overshoots the data.
  Eigen::VectorXd farthest() const {
    constexpr double largest = 0x1p60;
    Eigen::VectorXd far = nearest();
    const Eigen::VectorXd near_residuals = residuals(far);
    for (Eigen::Index k = 0; k < far.size(); ++k) {
      if (std::isfinite(amplitudes_.upper[k])) continue;
      Eigen::VectorXd alone = nearest();
      alone[k] = std::max(alone[k], 1.0);
      while (alone[k] < largest &&
             !((residuals(alone) - near_residuals).norm() > 2 * near_residuals.norm())) {
        alone[k] *= 2;
      }
      far[k] = alone[k];
    }
    return amplitudes_.upper.array().isFinite().select(amplitudes_.upper, far);
  }

  /// Where Gauss and Newton's steps lead from there.
  Point descended(Eigen::VectorXd start) const {
    Point now = at(std::move(start));
    std::optional<Step> last;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      const Step step{now.free, linear_solution(now.free)};
      const Point plain = at(step.to);
      Point next = last ? at(along(step, secant_length(*last, step))) : plain;
      if (is_same(plain, now) && is_same(next, now)) {
        // Where the squares tell nothing more, steps go on as long as they shrink.
        if (step.size() == 0 || (last && step.size() >= last->size())) break;
      } else {
        if (plain.square < next.square) next = plain;
        double length = 1;
        for (int halving = 0; halving < most_halvings && next.square > now.square; ++halving) {
          length /= 2;
          next = at(along(step, length));
        }
        if (!(next.square <= now.square)) break;
      }
      last = step;
      now = std::move(next);
    }
    return now;
  }

  /// The same, with the amplitudes that have no influence there as near to 0 as they may be.
  Eigen::VectorXd without_idle(Eigen::VectorXd free) const {
    const Eigen::MatrixXd columns = basis_ * slope_at(free);
    for (Eigen::Index k = 0; k < free.size(); ++k) {
      if ((columns.col(k).array() == 0).all()) free[k] = nearest()[k];
    }
    return free;
  }

 private:
  Eigen::VectorXd residuals(const Eigen::VectorXd& free) const {
    return basis_ * model_.coefficients(amplitudes_.all(free)) - values_;
  }

  /// d coefficient / d free amplitude.
  Eigen::MatrixXd slope_at(const Eigen::VectorXd& free) const {
    return model_.coefficient_jacobian(amplitudes_.all(free)) * amplitudes_.space.map;
  }

  /// The minimum of the problem that is linear near there. An amplitude without influence stays.
  Eigen::VectorXd linear_solution(const Eigen::VectorXd& free) const {
    const Eigen::VectorXd down = amplitudes_.lower - free;
    const Eigen::VectorXd up = amplitudes_.upper - free;
    const Eigen::VectorXd change =
        bounded_least_squares(basis_ * slope_at(free), -residuals(free), down, up);
    // Exactly at the bounds that the change reaches.
    const Eigen::VectorXd inside = within_bounds(free + change);
    return (change.array() == down.array())
        .select(amplitudes_.lower,
                (change.array() == up.array()).select(amplitudes_.upper, inside));
  }

  Eigen::VectorXd within_bounds(const Eigen::VectorXd& free) const {
    return free.cwiseMax(amplitudes_.lower).cwiseMin(amplitudes_.upper);
  }

  Eigen::VectorXd along(const Step& step, double length) const {
    return within_bounds(step.from + length * (step.to - step.from));
  }

  const BatchModel& model_;
  const FreeAmplitudes& amplitudes_;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd values_;
};

Eigen::VectorXd solve_affine(const BatchModel& model, const FreeAmplitudes& amplitudes,
                             const Eigen::MatrixXd& basis, const Eigen::VectorXd& values) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(amplitudes.lower.size());
  const Eigen::VectorXd offset = model.coefficients(amplitudes.all(none));
  const Eigen::MatrixXd slope =
      model.coefficient_jacobian(amplitudes.all(none)) * amplitudes.space.map;
  return bounded_least_squares(basis * slope, values - basis * offset, amplitudes.lower,
                               amplitudes.upper);
}

}  // namespace

FreeAmplitudes::FreeAmplitudes(const Box& box, Eigen::Index channel)
    : space(box.amplitudes),
      lower(box.amplitude_lower(space.free, channel)),
      upper(box.amplitude_upper(space.free, channel)) {}

Eigen::VectorXd solve_amplitudes(const BatchModel& model, const FreeAmplitudes& amplitudes,
                                 const Eigen::MatrixXd& basis, const Eigen::VectorXd& values) {
  if (model.coefficients_kind() != brdf::Coefficients::nonlinear) {
    return solve_affine(model, amplitudes, basis, values);
  }
  const NonlinearProblem problem(model, amplitudes, basis, values);
  const Point from_near = problem.descended(problem.nearest());
  const Point from_far = problem.descended(problem.farthest());
  const bool is_far_better = from_far.square < (1 - same_square) * from_near.square;
  return problem.without_idle(is_far_better ? from_far.free : from_near.free);
}

}  // namespace gonio::fit
