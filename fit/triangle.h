// The triangular factor that chunks of rows are folded into: a QR decomposition of as many rows as
// there are, in the memory of one chunk (TSQR: Demmel et al. 2012).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "fit/batch_model.h"

namespace gonio::fit {

/// For all rows [A | Y] so far: A'A = factor'factor, A'Y = factor'projected, and the rest of each
/// column of Y, which no combination of A's columns reaches, has the norm unreachable.
struct Triangle {
  Eigen::MatrixXd factor;       // [column, column], upper triangular
  Eigen::MatrixXd projected;    // [column, side]
  Eigen::VectorXd unreachable;  // [side]
};

/// Folds rows into a triangle. As accurate as the Householder reflections it is made of: no squared
/// condition number.
class Triangulation {
 public:
  Triangulation(std::size_t columns, std::size_t sides);

  /// Where the next rows [A | Y] are to be written, up to chunk_rows, each column column_stride
  /// after the one before; used up by fold().
  Eigen::MatrixXd& rows() { return rows_; }
  /// Folds the first `count` of rows() in. Rows from count on to the end of the last pack must be
  /// 0.
  void fold(std::size_t count);
  /// Folds the triangle of other rows in.
  void fold(const Triangle& other);

  Triangle triangle() const;

 private:
  Eigen::Index columns_;
  Eigen::MatrixXd triangle_;  // [column, column | side]
  Eigen::MatrixXd rows_;
  Eigen::VectorXd unreachable_;
};

std::vector<Triangle> triangles_of(const std::vector<Triangulation>& triangulations);

/// Per triangulation the triangle of all parts' rows; [part][triangulation], at least one part.
std::vector<Triangle> merged(std::span<const std::vector<Triangle>> parts);

}  // namespace gonio::fit
