// The exitant hemisphere seen from above: a direction is the point (x, y) of the unit disc, and
// area on the disc is projected solid angle. The directional albedo, the integral of
// f_r cos(theta_o) over the hemisphere, is therefore pi times the mean of f_r over the disc.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gonio::table {

struct DiscPoint {
  double x = 0;
  double y = 0;
};

/// Equal-area cells of the disc, rings times sectors, and which of them hold a point.
class DiscCoverage {
 public:
  /// The cells are as fine as the points allow: 4, 8 or 16 rings, so that a grid of polar angles
  /// leaves none empty by its step alone, and 12 or 24 sectors, centred on multiples of 30 or
  /// 15 deg.
  explicit DiscCoverage(std::span<const DiscPoint> points);

  std::size_t cells() const { return covered_.size(); }
  /// The share of the cells that hold a point, 0 to 1.
  double share() const;

 private:
  std::vector<bool> covered_;
};

/// The mean of scattered values over the whole disc. Values are averaged in 64 x 64 cells of equal
/// area, and a cell without any takes the value of the nearest one that has: dense clusters of
/// samples, coarse steps and gaps weigh by the area that they stand for.
class DiscAverage {
 public:
  explicit DiscAverage(std::span<const DiscPoint> points);

  /// The mean of values[index[k]] at point k; NaN are holes. NaN if all are.
  double mean(std::span<const double> values, std::span<const std::uint32_t> index) const;

 private:
  std::vector<std::uint16_t> cell_;    // of each point
  std::vector<std::uint32_t> weight_;  // of each cell: how many cells take its value
};

}  // namespace gonio::table
