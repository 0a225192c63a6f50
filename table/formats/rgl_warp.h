// A density over the unit square that is bilinear between the nodes of a grid, and the warp that
// turns uniform points into points of that density: first the row by the marginal, then along x by
// the conditional distribution. One slice per incident direction; between slices all is linear.
//
// Source: the inversion of cumulative distributions, as Dupuy & Jakob 2018 use it for the visible
// normals.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace gonio::table {

struct Point {
  double x, y;
};

/// Up to two slices and how much each counts; the shares add up to 1.
struct SliceMix {
  std::array<std::size_t, 2> slice;
  std::array<double, 2> share;
};

class Warp {
 public:
  /// `values`: [slice][y][x], at least 0, with at least two nodes along x and y, which include both
  /// ends of the square. Each slice is scaled to an integral of 1. A slice that is 0 everywhere is
  /// taken as uniform.
  Warp(std::span<const float> values, std::size_t slices, std::size_t rows, std::size_t columns);

  /// The density at a point.
  double density(const Point& p, const SliceMix& mix) const;
  /// The uniform point whose warp lands on `p`; within the unit square.
  Point inverse(const Point& p, const SliceMix& mix) const;
  /// Where a uniform point is warped to.
  Point forward(const Point& s, const SliceMix& mix) const;

 private:
  struct Cell;
  Cell cell_at(const Point& p) const;
  double value(const SliceMix& mix, std::size_t row, std::size_t column) const;
  /// The integral along x of a row up to a node, in steps of the grid; the last is that of the row.
  double conditional(const SliceMix& mix, std::size_t row, std::size_t column) const;
  double marginal(const SliceMix& mix, std::size_t row) const;

  std::size_t rows_, columns_;
  std::vector<float> values_;
  std::vector<double> scale_;        // per slice
  std::vector<double> conditional_;  // [slice][row][column]
  std::vector<double> marginal_;     // [slice][row]
};

}  // namespace gonio::table
