// The problem near given parameters, to first order, in a few rows per channel that stand for all
// the samples: Levenberg-Marquardt sees a residual block only through J'J, J'r and r'r.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <vector>

namespace gonio::fit {

/// residuals + amplitude_jacobian * (change of amplitudes) + shape_jacobian * (change of shape).
struct ChannelSystem {
  Eigen::VectorXd residuals;
  Eigen::MatrixXd amplitude_jacobian;  // [row, amplitude]
  Eigen::MatrixXd shape_jacobian;      // [row, shape]
};

/// One system per channel. The squares of all residuals sum to the full problem's.
using LinearSystem = std::vector<ChannelSystem>;

/// Half the sum of squares, as Ceres counts it.
inline double cost_of(const LinearSystem& system) {
  double sum = 0;
  for (const ChannelSystem& channel : system) sum += channel.residuals.squaredNorm();
  return sum / 2;
}

/// The norm of the residuals that a model of amplitude 0 would have, to first order.
inline double norm_of_data(const LinearSystem& system, const Eigen::MatrixXd& amplitudes) {
  double square = 0;
  for (std::size_t c = 0; c < system.size(); ++c) {
    square += (system[c].residuals - system[c].amplitude_jacobian * amplitudes.col(Eigen::Index(c)))
                  .squaredNorm();
  }
  return std::sqrt(square);
}

}  // namespace gonio::fit
