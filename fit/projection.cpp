#include "fit/projection.h"

#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <vector>

namespace gonio::fit {
namespace {

/// Columns whose part orthogonal to the others is smaller than this share count as dependent.
constexpr double rank_threshold = 1e-13;

enum class Place { free, at_lower, at_upper };

/// Least squares in the free unknowns, the others standing at their bounds.
Eigen::VectorXd solve_with(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& rhs,
                           const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                           const std::vector<Place>& places) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(matrix.cols());
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
    switch (places[std::size_t(k)]) {
      case Place::free:
        free.push_back(k);
        break;
      case Place::at_lower:
        x[k] = lower[k];
        break;
      case Place::at_upper:
        x[k] = upper[k];
        break;
    }
  }
  if (free.empty()) return x;
  // Unit columns: the rank decision must not depend on the units of the amplitudes.
  Eigen::MatrixXd columns(matrix.rows(), Eigen::Index(free.size()));
  Eigen::VectorXd norms(columns.cols());
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    norms[k] = matrix.col(free[std::size_t(k)]).norm();
    columns.col(k) = matrix.col(free[std::size_t(k)]) / (norms[k] > 0 ? norms[k] : 1);
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(rank_threshold);
  qr.compute(columns);
  const Eigen::VectorXd solution = qr.solve(Eigen::VectorXd(rhs - matrix * x));
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    x[free[std::size_t(k)]] = norms[k] > 0 ? solution[k] / norms[k] : 0;
  }
  return x;
}

bool inside(const Eigen::VectorXd& x, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
}

/// Steps `places` to the next of all combinations; false after the last. A fixed unknown
/// (lower = upper) only ever stands at its lower bound, an unbounded one never at a bound.
bool next_places(std::vector<Place>& places, const Eigen::VectorXd& lower,
                 const Eigen::VectorXd& upper) {
  for (std::size_t k = 0; k < places.size(); ++k) {
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

std::vector<Place> initial_places(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  std::vector<Place> places(std::size_t(lower.size()), Place::free);
  for (Eigen::Index k = 0; k < lower.size(); ++k) {
    if (lower[k] == upper[k]) places[std::size_t(k)] = Place::at_lower;
  }
  return places;
}

}  // namespace

Eigen::VectorXd bounded_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& rhs,
                                      const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  std::vector<Place> places = initial_places(lower, upper);
  Eigen::VectorXd x = solve_with(matrix, rhs, lower, upper, places);
  if (inside(x, lower, upper)) return x;
  // The problem is convex: its solution is the best of the active sets' solutions that are inside.
  Eigen::VectorXd best = x.cwiseMax(lower).cwiseMin(upper);
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

Projected project(const Compressed& compressed, const BatchModel& model, const Box& box,
                  bool with_jacobian) {
  const Eigen::Index channels = compressed.projected.cols();
  const Eigen::Index rows = compressed.projected.rows();
  const auto amplitude_count = Eigen::Index(model.amplitude_count());
  const auto derivatives = model.derivatives();

  Projected result;
  result.amplitudes.resize(amplitude_count, channels);
  result.residuals.resize(channels * (rows + 1));
  if (with_jacobian) {
    result.jacobian.setZero(result.residuals.size(), Eigen::Index(model.shape_count()));
  }
  for (Eigen::Index c = 0; c < channels; ++c) {
    const Eigen::MatrixXd& factor = compressed.factor(c);
    const Eigen::VectorXd lower = box.amplitude_lower.col(c);
    const Eigen::VectorXd upper = box.amplitude_upper.col(c);
    // Below the first amplitude_count rows the triangle's basis columns are 0.
    const Eigen::MatrixXd basis = factor.topLeftCorner(amplitude_count, amplitude_count);
    const Eigen::VectorXd beta = bounded_least_squares(
        basis, compressed.projected.col(c).head(amplitude_count), lower, upper);
    result.amplitudes.col(c) = beta;
    const Eigen::Index first = c * (rows + 1);
    result.residuals.segment(first, rows) = compressed.projected.col(c);
    result.residuals.segment(first, amplitude_count) -= basis * beta;
    result.residuals[first + rows] = compressed.unreachable[c];
    if (!with_jacobian) continue;

    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, Eigen::Index(model.shape_count()));
    for (std::size_t d = 0; d < derivatives.size(); ++d) {
      jacobian.col(Eigen::Index(derivatives[d].shape)) -=
          factor.col(amplitude_count + Eigen::Index(d)) *
          beta[Eigen::Index(derivatives[d].amplitude)];
    }
    // The amplitudes that can move follow the shape: their columns are projected out.
    Eigen::MatrixXd moving(amplitude_count, amplitude_count);
    Eigen::Index moving_count = 0;
    for (Eigen::Index k = 0; k < amplitude_count; ++k) {
      const double norm = basis.col(k).norm();
      if (beta[k] <= lower[k] || beta[k] >= upper[k] || norm == 0) continue;
      moving.col(moving_count++) = basis.col(k) / norm;
    }
    if (moving_count > 0 && jacobian.cols() > 0) {
      const Eigen::MatrixXd free = moving.leftCols(moving_count);
      Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
      qr.setThreshold(rank_threshold);
      qr.compute(free);
      auto top = jacobian.topRows(amplitude_count);
      const Eigen::MatrixXd reached = free * qr.solve(Eigen::MatrixXd(top));
      top -= reached;
    }
    result.jacobian.middleRows(first, rows) = jacobian;
  }
  return result;
}

}  // namespace gonio::fit
