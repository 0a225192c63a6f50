// The problem near given parameters, to first order, in a few rows per channel that stand for all
// the samples: Levenberg-Marquardt sees a residual block only through J'J, J'r and r'r.
#pragma once

#include <Eigen/Core>
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

}  // namespace gonio::fit
