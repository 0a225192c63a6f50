#include "fit/bounded_least_squares.h"

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace gonio::fit {
namespace {

/// A few unknowns need no memory from the heap, which would cost more than the numbers.
constexpr int most_unknowns = 16;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                  most_unknowns, most_unknowns>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most_unknowns, 1>;

enum class Place : std::uint8_t { free, at_lower, at_upper };
using Places = std::array<Place, most_unknowns>;

/// Least squares in the free unknowns, the others standing at their bounds.
SmallVector solve_with(const SmallMatrix& matrix, const SmallVector& rhs, const SmallVector& lower,
                       const SmallVector& upper, const Places& places) {
  SmallVector x = SmallVector::Zero(matrix.cols());
  std::array<Eigen::Index, most_unknowns> free{};
  Eigen::Index free_count = 0;
  for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
    switch (places[std::size_t(k)]) {
      case Place::free:
        free[std::size_t(free_count++)] = k;
        break;
      case Place::at_lower:
        x[k] = lower[k];
        break;
      case Place::at_upper:
        x[k] = upper[k];
        break;
    }
  }
  if (free_count == 0) return x;
  // Unit columns: the rank decision must not depend on the units of the amplitudes.
  SmallMatrix columns(matrix.rows(), free_count);
  SmallVector norms(columns.cols());
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    norms[k] = matrix.col(free[std::size_t(k)]).norm();
    columns.col(k) = matrix.col(free[std::size_t(k)]) / (norms[k] > 0 ? norms[k] : 1);
  }
  Eigen::ColPivHouseholderQR<SmallMatrix> qr;
  qr.setThreshold(dependent_share);
  qr.compute(columns);
  const SmallVector solution = qr.solve(SmallVector(rhs - matrix * x));
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    x[free[std::size_t(k)]] = norms[k] > 0 ? solution[k] / norms[k] : 0;
  }
  return x;
}

bool inside(const SmallVector& x, const SmallVector& lower, const SmallVector& upper) {
  return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
}

/// Steps `places` to the next of all combinations; false after the last. A fixed unknown
/// (lower = upper) only ever stands at its lower bound, an unbounded one never at a bound.
bool next_places(Places& places, const SmallVector& lower, const SmallVector& upper) {
  for (std::size_t k = 0; k < std::size_t(lower.size()); ++k) {
    const auto i = Eigen::Index(k);
    if (lower[i] == upper[i]) continue;
    if (places[k] == Place::free && std::isfinite(lower[i])) {
      places[k] = Place::at_lower;
      return true;
    }
    if (places[k] != Place::at_upper && std::isfinite(upper[i])) {
      places[k] = Place::at_upper;
      return true;
    }
    places[k] = Place::free;
  }
  return false;
}

Places initial_places(const SmallVector& lower, const SmallVector& upper) {
  Places places{};
  for (Eigen::Index k = 0; k < lower.size(); ++k) {
    if (lower[k] == upper[k]) places[std::size_t(k)] = Place::at_lower;
  }
  return places;
}

/// The same problem in as many rows as unknowns.
std::pair<SmallMatrix, SmallVector> reduced(const Eigen::MatrixXd& matrix,
                                            const Eigen::VectorXd& rhs) {
  if (matrix.rows() <= most_unknowns) return {matrix, rhs};
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(matrix);
  const Eigen::VectorXd rotated = qr.householderQ().adjoint() * rhs;
  return {qr.matrixQR().topRows(matrix.cols()).triangularView<Eigen::Upper>(),
          rotated.head(matrix.cols())};
}

}  // namespace

Eigen::VectorXd bounded_least_squares(const Eigen::MatrixXd& tall, const Eigen::VectorXd& tall_rhs,
                                      const Eigen::VectorXd& lower_bounds,
                                      const Eigen::VectorXd& upper_bounds) {
  const auto [matrix, rhs] = reduced(tall, tall_rhs);
  const SmallVector lower = lower_bounds;
  const SmallVector upper = upper_bounds;
  Places places = initial_places(lower, upper);
  SmallVector x = solve_with(matrix, rhs, lower, upper, places);
  if (inside(x, lower, upper)) return x;
  // The problem is convex: its solution is the best of the active sets' solutions that are inside.
  SmallVector best = x.cwiseMax(lower).cwiseMin(upper);
  double best_cost = std::numeric_limits<double>::infinity();
  while (next_places(places, lower, upper)) {
    x = solve_with(matrix, rhs, lower, upper, places);
    if (!inside(x, lower, upper)) continue;
    const double cost = (matrix * x - rhs).squaredNorm();
    if (cost < best_cost) {
      best_cost = cost;
      best = x;
    }
  }
  return best;
}

}  // namespace gonio::fit
