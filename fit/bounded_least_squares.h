// Least squares in a box.
#pragma once

#include <Eigen/Core>

namespace gonio::fit {

/// Columns whose part orthogonal to the others is smaller than this share count as dependent.
inline constexpr double dependent_share = 1e-13;

/// Minimises |matrix x - rhs|^2 subject to lower <= x <= upper (elementwise). Exact for the few
/// unknowns it is meant for: the active sets are enumerated if the free solution is not inside.
/// Unknowns that the matrix does not determine are 0, or the bound nearest to 0. At most 16
/// unknowns.
Eigen::VectorXd bounded_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& rhs,
                                      const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

}  // namespace gonio::fit
