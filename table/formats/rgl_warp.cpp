#include "table/formats/rgl_warp.h"

#include <algorithm>
#include <cmath>

namespace gonio::table {

namespace {

/// The t in 0..1 at which the integral of a straight line from a to b over 0..t is `area`.
double where_area_is(double a, double b, double area) {
  const double root = std::sqrt(std::max(a * a + 2 * area * (b - a), 0.0));
  const double sum = a + root;  // without the cancellation of (root - a) / (b - a)
  return sum > 0 ? std::clamp(2 * area / sum, 0.0, 1.0) : 0.0;
}

/// The last of 0 .. count - 2 at which the rising function `at` is not above `target`.
template <class Rising>
std::size_t interval_of(std::size_t count, double target, const Rising& at) {
  std::size_t low = 0;
  std::size_t high = count - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (at(middle) <= target ? low : high) = middle;
  }
  return low;
}

}  // namespace

/// The cell of the grid that holds a point, and where in it.
struct Warp::Cell {
  std::size_t column, row;
  double x, y;
};

Warp::Warp(std::span<const float> values, std::size_t slices, std::size_t rows, std::size_t columns)
    : rows_(rows),
      columns_(columns),
      values_(values.begin(), values.end()),
      scale_(slices, 1),
      conditional_(values.size()),
      marginal_(slices * rows) {
  const double cells = static_cast<double>((rows - 1) * (columns - 1));
  for (std::size_t slice = 0; slice < slices; ++slice) {
    float* const first = values_.data() + slice * rows * columns;
    if (std::all_of(first, first + rows * columns, [](float value) { return value == 0; })) {
      std::fill(first, first + rows * columns, 1.0F);
    }
    double* const marginal = marginal_.data() + slice * rows;
    double total_before = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      double* const conditional = conditional_.data() + (slice * rows + row) * columns;
      for (std::size_t column = 1; column < columns; ++column) {
        const double left = first[row * columns + column - 1];
        const double right = first[row * columns + column];
        conditional[column] = conditional[column - 1] + (left + right) / 2;
      }
      const double total = conditional[columns - 1];
      if (row > 0) marginal[row] = marginal[row - 1] + (total_before + total) / 2;
      total_before = total;
    }
    scale_[slice] = 1 / marginal[rows - 1];
    std::for_each(marginal, marginal + rows, [&](double& value) { value *= scale_[slice]; });
    double* const conditional = conditional_.data() + slice * rows * columns;
    std::for_each(conditional, conditional + rows * columns,
                  [&](double& value) { value *= scale_[slice]; });
    scale_[slice] *= cells;
  }
}

double Warp::value(const SliceMix& mix, std::size_t row, std::size_t column) const {
  double sum = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::size_t slice = mix.slice[k];
    sum += mix.share[k] * scale_[slice] * values_[(slice * rows_ + row) * columns_ + column];
  }
  return sum;
}

double Warp::conditional(const SliceMix& mix, std::size_t row, std::size_t column) const {
  double sum = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    sum += mix.share[k] * conditional_[(mix.slice[k] * rows_ + row) * columns_ + column];
  }
  return sum;
}

double Warp::marginal(const SliceMix& mix, std::size_t row) const {
  return mix.share[0] * marginal_[mix.slice[0] * rows_ + row] +
         mix.share[1] * marginal_[mix.slice[1] * rows_ + row];
}

Warp::Cell Warp::cell_at(const Point& p) const {
  const auto split = [](double coordinate, std::size_t nodes, std::size_t& index, double& rest) {
    const double scaled = std::clamp(coordinate, 0.0, 1.0) * static_cast<double>(nodes - 1);
    index = std::min(static_cast<std::size_t>(scaled), nodes - 2);
    rest = scaled - static_cast<double>(index);
  };
  Cell cell{};
  split(p.x, columns_, cell.column, cell.x);
  split(p.y, rows_, cell.row, cell.y);
  return cell;
}

double Warp::density(const Point& p, const SliceMix& mix) const {
  const Cell cell = cell_at(p);
  const std::size_t column = cell.column;
  const std::size_t row = cell.row;
  const double x = cell.x;
  const double y = cell.y;
  const auto along_x = [&](std::size_t r) {
    return (1 - x) * value(mix, r, column) + x * value(mix, r, column + 1);
  };
  return (1 - y) * along_x(row) + y * along_x(row + 1);
}

Point Warp::inverse(const Point& p, const SliceMix& mix) const {
  const Cell cell = cell_at(p);
  const std::size_t column = cell.column;
  const std::size_t row = cell.row;
  const double x = cell.x;
  const double y = cell.y;
  const auto between_rows = [&](const auto& of_row) {
    return (1 - y) * of_row(row) + y * of_row(row + 1);
  };
  // Values in units of the integrals: per cell.
  const double cells = static_cast<double>((rows_ - 1) * (columns_ - 1));
  const double left = between_rows([&](std::size_t r) { return value(mix, r, column); }) / cells;
  const double right =
      between_rows([&](std::size_t r) { return value(mix, r, column + 1); }) / cells;
  const double before = between_rows([&](std::size_t r) { return conditional(mix, r, column); });
  const double whole =
      between_rows([&](std::size_t r) { return conditional(mix, r, columns_ - 1); });
  const double row_below = conditional(mix, row, columns_ - 1);
  const double row_above = conditional(mix, row + 1, columns_ - 1);
  const double along_x = before + x * (left + x / 2 * (right - left));
  const double along_y = marginal(mix, row) + y * (row_below + y / 2 * (row_above - row_below));
  return {whole > 0 ? std::clamp(along_x / whole, 0.0, 1.0) : p.x, std::clamp(along_y, 0.0, 1.0)};
}

Point Warp::forward(const Point& s, const SliceMix& mix) const {
  const double cells = static_cast<double>((rows_ - 1) * (columns_ - 1));
  const std::size_t row = interval_of(rows_, s.y, [&](std::size_t r) { return marginal(mix, r); });
  const double y = where_area_is(conditional(mix, row, columns_ - 1),
                                 conditional(mix, row + 1, columns_ - 1), s.y - marginal(mix, row));
  const auto between_rows = [&](const auto& of_row) {
    return (1 - y) * of_row(row) + y * of_row(row + 1);
  };
  const auto up_to = [&](std::size_t column) {
    return between_rows([&](std::size_t r) { return conditional(mix, r, column); });
  };
  const double target = s.x * up_to(columns_ - 1);
  const std::size_t column = interval_of(columns_, target, up_to);
  const double x =
      where_area_is(between_rows([&](std::size_t r) { return value(mix, r, column); }) / cells,
                    between_rows([&](std::size_t r) { return value(mix, r, column + 1); }) / cells,
                    target - up_to(column));
  return {(static_cast<double>(column) + x) / static_cast<double>(columns_ - 1),
          (static_cast<double>(row) + y) / static_cast<double>(rows_ - 1)};
}

}  // namespace gonio::table
