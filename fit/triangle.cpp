#include "fit/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/columns.h"

namespace gonio::fit {
namespace {

using brdf::Pack;

/// One Householder reflection per column: it acts on the triangle's row of that column and on all
/// the new rows. `triangle` and `rows` are column-major.
GONIO_FOR_EACH_CPU void reflect(double* triangle, std::size_t columns, std::size_t sides,
                                double* rows, std::size_t count) {
  for (std::size_t k = 0; k < columns; ++k) {
    const double* tail = rows + k * std::size_t(column_stride);
    const double tail_square = inner_product(tail, tail, count);
    if (!(tail_square > std::numeric_limits<double>::min())) continue;
    double& diagonal = triangle[k + k * columns];
    const double norm = std::sqrt(diagonal * diagonal + tail_square);
    const double reflected = diagonal > 0 ? -norm : norm;
    const double head = diagonal - reflected;
    const double scale = 2 / (head * head + tail_square);
    for (std::size_t j = k + 1; j < columns + sides; ++j) {
      double& entry = triangle[k + j * columns];
      double* column = rows + j * std::size_t(column_stride);
      const double multiple = scale * (head * entry + inner_product(tail, column, count));
      entry -= multiple * head;
      add_multiple(column, -multiple, tail, count);
    }
    diagonal = reflected;
  }
}

}  // namespace

Triangulation::Triangulation(std::size_t columns, std::size_t sides)
    : columns_(Eigen::Index(columns)),
      triangle_(Eigen::MatrixXd::Zero(columns_, columns_ + Eigen::Index(sides))),
      rows_(column_stride, columns_ + Eigen::Index(sides)),
      unreachable_(Eigen::VectorXd::Zero(Eigen::Index(sides))) {}

void Triangulation::fold(std::size_t count) {
  const std::size_t padded = (count + Pack::size - 1) / Pack::size * Pack::size;
  reflect(triangle_.data(), std::size_t(columns_), std::size_t(unreachable_.size()), rows_.data(),
          padded);
  for (Eigen::Index side = 0; side < unreachable_.size(); ++side) {
    unreachable_[side] =
        std::hypot(unreachable_[side], rows_.col(columns_ + side).head(Eigen::Index(count)).norm());
  }
}

void Triangulation::fold(const Triangle& other) {
  const std::size_t padded = (std::size_t(columns_) + Pack::size - 1) / Pack::size * Pack::size;
  rows_.topRows(Eigen::Index(padded)).setZero();
  rows_.topLeftCorner(columns_, columns_) = other.factor;
  rows_.topRightCorner(columns_, unreachable_.size()) = other.projected;
  fold(std::size_t(columns_));
  for (Eigen::Index side = 0; side < unreachable_.size(); ++side) {
    unreachable_[side] = std::hypot(unreachable_[side], other.unreachable[side]);
  }
}

Triangle Triangulation::triangle() const {
  return {triangle_.leftCols(columns_), triangle_.rightCols(unreachable_.size()), unreachable_};
}

std::vector<Triangle> triangles_of(const std::vector<Triangulation>& triangulations) {
  std::vector<Triangle> triangles;
  for (const Triangulation& t : triangulations) triangles.push_back(t.triangle());
  return triangles;
}

std::vector<Triangle> merged(std::span<const std::vector<Triangle>> parts) {
  if (parts.size() == 1) return parts.front();
  std::vector<Triangle> total;
  for (std::size_t t = 0; t < parts.front().size(); ++t) {
    const Triangle& first = parts.front()[t];
    Triangulation sum(std::size_t(first.factor.cols()), std::size_t(first.projected.cols()));
    for (const std::vector<Triangle>& part : parts) sum.fold(part[t]);
    total.push_back(sum.triangle());
  }
  return total;
}

}  // namespace gonio::fit
