// Which shapes are looked at before any is solved for.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fit/options.h"
#include "fit/parameters.h"

namespace gonio::fit {

/// Points in the unknown shape parameters' search ranges, as far as the box leaves them: up to two
/// dimensions a grid, more scattered points. Fixed parameters keep their value.
class Scan {
 public:
  /// `with_start`: parameters with a start value keep it.
  Scan(const brdf::Model& model, const Box& box, const Options& options, bool with_start);

  std::span<const std::vector<double>> shapes() const { return shapes_; }
  /// The shapes worth a solution, by the costs at all of them: local minima, the best first.
  std::vector<std::size_t> minima(std::span<const double> costs) const;

 private:
  bool is_grid_minimum(std::size_t number, std::span<const double> costs) const;
  bool is_near_any(std::span<const std::size_t> others, std::size_t number) const;

  std::vector<std::vector<double>> shapes_;
  std::size_t most_minima_;
  /// Points along each axis of a grid, the first axis varying fastest; empty where scattered.
  std::vector<std::size_t> axis_sizes_;
  /// Of scattered points the shares of the search ranges.
  std::vector<std::vector<double>> places_;
};

}  // namespace gonio::fit
