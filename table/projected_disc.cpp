#include "table/projected_disc.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>

namespace gonio::table {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t edge = 64;  // cells along one edge of the square

// The disc and the square [-1, 1]^2, mapped to one another with areas kept (Shirley & Chiu, A Low
// Distortion Map Between Disk and Square, 1997).

DiscPoint square_from_disc(const DiscPoint& p) {
  const double radius = std::min(std::hypot(p.x, p.y), 1.0);
  if (radius == 0) return {0, 0};
  const bool beside_x = std::abs(p.x) >= std::abs(p.y);
  const double major = std::copysign(radius, beside_x ? p.x : p.y);
  const double minor = major * std::atan(beside_x ? p.y / p.x : p.x / p.y) * 4 / pi;
  return beside_x ? DiscPoint{major, minor} : DiscPoint{minor, major};
}

DiscPoint disc_from_square(const DiscPoint& p) {
  const bool beside_x = std::abs(p.x) >= std::abs(p.y);
  const double major = beside_x ? p.x : p.y;
  const double minor = beside_x ? p.y : p.x;
  if (major == 0) return {0, 0};
  const double angle = pi / 4 * minor / major;
  const DiscPoint turned{major * std::cos(angle), major * std::sin(angle)};
  return beside_x ? turned : DiscPoint{turned.y, turned.x};
}

std::size_t cell_along(double coordinate) {
  const double scaled = (coordinate + 1) / 2 * static_cast<double>(edge);
  return std::min(static_cast<std::size_t>(std::max(scaled, 0.0)), edge - 1);
}

std::size_t cell_of(const DiscPoint& p) {
  const DiscPoint square = square_from_disc(p);
  return cell_along(square.y) * edge + cell_along(square.x);
}

DiscPoint centre_of(std::size_t cell) {
  const auto coordinate = [](std::size_t k) {
    return (2 * static_cast<double>(k) + 1) / static_cast<double>(edge) - 1;
  };
  return disc_from_square({coordinate(cell % edge), coordinate(cell / edge)});
}

/// How many different radii there are, with polar angles told apart to 0.5 deg.
std::size_t distinct_polar_angles(std::span<const DiscPoint> points) {
  std::bitset<181> seen;
  for (const DiscPoint& p : points) {
    const double theta = std::asin(std::min(std::hypot(p.x, p.y), 1.0));
    seen.set(static_cast<std::size_t>(std::lround(theta * 360 / pi)));
  }
  return seen.count();
}

/// A cell that holds points, and the middle of them.
struct FilledCell {
  std::size_t cell;
  DiscPoint middle;
};

std::vector<FilledCell> filled_cells(std::span<const DiscPoint> points,
                                     std::span<const std::uint16_t> cell) {
  std::vector<DiscPoint> sum(edge * edge);
  std::vector<double> count(edge * edge);
  for (std::size_t k = 0; k < points.size(); ++k) {
    sum[cell[k]].x += points[k].x;
    sum[cell[k]].y += points[k].y;
    ++count[cell[k]];
  }
  std::vector<FilledCell> filled;
  for (std::size_t c = 0; c < sum.size(); ++c) {
    if (count[c] > 0) filled.push_back({c, {sum[c].x / count[c], sum[c].y / count[c]}});
  }
  return filled;
}

std::size_t nearest(const std::vector<FilledCell>& filled, const DiscPoint& p) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const FilledCell& candidate : filled) {
    const double dx = candidate.middle.x - p.x;
    const double dy = candidate.middle.y - p.y;
    const double distance = dx * dx + dy * dy;
    if (distance < least) {
      least = distance;
      best = candidate.cell;
    }
  }
  return best;
}

}  // namespace

DiscCoverage::DiscCoverage(std::span<const DiscPoint> points) {
  const std::size_t polar_angles = distinct_polar_angles(points);
  std::size_t rings = 16;
  std::size_t sectors = 24;
  while (rings > 4 && 2 * rings > polar_angles) rings /= 2;
  // Four samples per cell: fewer would leave cells empty by chance.
  while (rings > 4 && 4 * rings * sectors > points.size()) rings /= 2;
  if (4 * rings * sectors > points.size()) sectors = 12;

  covered_.resize(rings * sectors);
  for (const DiscPoint& p : points) {
    const double area = std::min(p.x * p.x + p.y * p.y, 1.0);
    const std::size_t ring =
        std::min(static_cast<std::size_t>(area * static_cast<double>(rings)), rings - 1);
    const double turn = std::atan2(p.y, p.x) / (2 * pi);
    const auto sector = std::lround((turn + 1) * static_cast<double>(sectors));
    covered_[ring * sectors + static_cast<std::size_t>(sector) % sectors] = true;
  }
}

double DiscCoverage::share() const {
  const auto count = std::count(covered_.begin(), covered_.end(), true);
  return static_cast<double>(count) / static_cast<double>(covered_.size());
}

DiscAverage::DiscAverage(std::span<const DiscPoint> points) : weight_(edge * edge) {
  cell_.reserve(points.size());
  for (const DiscPoint& p : points) cell_.push_back(static_cast<std::uint16_t>(cell_of(p)));

  const std::vector<FilledCell> filled = filled_cells(points, cell_);
  for (const FilledCell& own : filled) weight_[own.cell] = 1;
  if (filled.empty()) return;
  const std::vector<std::uint32_t> is_filled = weight_;
  for (std::size_t cell = 0; cell < weight_.size(); ++cell) {
    if (is_filled[cell] == 0) ++weight_[nearest(filled, centre_of(cell))];
  }
}

double DiscAverage::mean(std::span<const double> values,
                         std::span<const std::uint32_t> index) const {
  std::vector<double> sums(weight_.size());
  std::vector<std::uint32_t> counts(weight_.size());
  for (std::size_t k = 0; k < cell_.size(); ++k) {
    const double value = values[index[k]];
    if (std::isnan(value)) continue;
    sums[cell_[k]] += value;
    ++counts[cell_[k]];
  }
  double sum = 0;
  double weight = 0;
  for (std::size_t cell = 0; cell < sums.size(); ++cell) {
    if (counts[cell] == 0) continue;
    sum += weight_[cell] * (sums[cell] / counts[cell]);
    weight += weight_[cell];
  }
  return sum / weight;
}

}  // namespace gonio::table
