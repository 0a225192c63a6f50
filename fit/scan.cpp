#include "fit/scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "fit/scale.h"

namespace gonio::fit {
namespace {

/// Up to two dimensions are scanned on a grid: a basin of attraction in a roughness spans about a
/// factor of two. More are scanned at scattered points.
std::size_t points_per_axis(std::size_t dimensions) { return dimensions == 1 ? 20 : 10; }
std::size_t scattered_points(std::size_t dimensions) { return std::size_t(256) << dimensions; }
std::size_t most_minima(std::size_t dimensions) { return dimensions <= 2 ? 4 : 10; }

/// What is known of each shape parameter before the scan: fixed ones, and with `with_start` those
/// that the user starts.
std::vector<std::optional<double>> known_shape(const brdf::Model& model, const Box& box,
                                               const Options& options, bool with_start) {
  std::vector<std::optional<double>> known(model.shape().size());
  for (std::size_t j = 0; j < known.size(); ++j) {
    if (box.shape_lower[j] == box.shape_upper[j]) {
      known[j] = box.shape_lower[j];
      continue;
    }
    if (!with_start) continue;
    for (const ParameterSetting& setting : options.start) {
      if (setting.parameter == model.shape()[j].name) known[j] = setting.value;
    }
  }
  return known;
}

/// The part of the search range that the box leaves.
std::pair<double, double> search_range(const brdf::Model& model, const Box& box, std::size_t j) {
  const brdf::Parameter& descriptor = model.shape()[j].descriptor;
  return {std::clamp(descriptor.search_lower, box.shape_lower[j], box.shape_upper[j]),
          std::clamp(descriptor.search_upper, box.shape_lower[j], box.shape_upper[j])};
}

/// The product of the axes: the shapes in the order that is_grid_minimum() counts in.
std::vector<std::vector<double>> grid_shapes(const std::vector<std::vector<double>>& axes) {
  std::size_t count = 1;
  for (const std::vector<double>& axis : axes) count *= axis.size();
  std::vector<std::vector<double>> shapes(count);
  for (std::size_t number = 0; number < count; ++number) {
    std::size_t rest = number;
    for (const std::vector<double>& axis : axes) {
      shapes[number].push_back(axis[rest % axis.size()]);
      rest /= axis.size();
    }
  }
  return shapes;
}

std::vector<std::vector<double>> axes_of(const brdf::Model& model, const Box& box,
                                         std::span<const std::optional<double>> known,
                                         std::size_t count) {
  std::vector<std::vector<double>> axes(known.size());
  for (std::size_t j = 0; j < known.size(); ++j) {
    if (known[j]) {
      axes[j] = {*known[j]};
      continue;
    }
    const auto [lower, upper] = search_range(model, box, j);
    for (std::size_t i = 0; i < count; ++i) {
      axes[j].push_back(parameter_between(model.shape()[j].descriptor.scale, lower, upper,
                                          double(i) / double(count - 1)));
    }
  }
  return axes;
}

/// Halton's (1960) points: the digits of the number in the given prime base, mirrored.
double radical_inverse(std::size_t number, std::size_t base) {
  double result = 0;
  double place = 1;
  for (; number > 0; number /= base) {
    place /= double(base);
    result += place * double(number % base);
  }
  return result;
}

/// Points scattered evenly over the unknown parameters' search ranges; `places` gets each point's
/// shares of the ranges.
std::vector<std::vector<double>> scattered_shapes(const brdf::Model& model, const Box& box,
                                                  std::span<const std::optional<double>> known,
                                                  std::size_t count,
                                                  std::vector<std::vector<double>>& places) {
  constexpr std::array<std::size_t, 8> bases{2, 3, 5, 7, 11, 13, 17, 19};
  std::vector<std::vector<double>> shapes;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> shape;
    places.emplace_back();
    for (std::size_t j = 0; j < known.size(); ++j) {
      const auto [lower, upper] = search_range(model, box, j);
      if (known[j]) {
        shape.push_back(*known[j]);
        continue;
      }
      places[i].push_back(radical_inverse(i + 1, bases[places[i].size() % bases.size()]));
      shape.push_back(
          parameter_between(model.shape()[j].descriptor.scale, lower, upper, places[i].back()));
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

}  // namespace

Scan::Scan(const brdf::Model& model, const Box& box, const Options& options, bool with_start) {
  const std::vector<std::optional<double>> known = known_shape(model, box, options, with_start);
  const auto dimensions = std::size_t(std::count(known.begin(), known.end(), std::nullopt));
  most_minima_ = most_minima(dimensions);
  if (dimensions > 2) {
    shapes_ = scattered_shapes(model, box, known, scattered_points(dimensions), places_);
    return;
  }
  const std::vector<std::vector<double>> axes =
      axes_of(model, box, known, points_per_axis(dimensions));
  for (const std::vector<double>& axis : axes) axis_sizes_.push_back(axis.size());
  shapes_ = grid_shapes(axes);
}

std::vector<std::size_t> Scan::minima(std::span<const double> costs) const {
  std::vector<std::size_t> order(shapes_.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  std::vector<std::size_t> found;
  for (const std::size_t i : order) {
    if (found.size() == most_minima_) break;
    if (places_.empty() ? is_grid_minimum(i, costs) : !is_near_any(found, i)) found.push_back(i);
  }
  return found;
}

/// No neighbour along an axis is lower.
bool Scan::is_grid_minimum(std::size_t number, std::span<const double> costs) const {
  std::size_t stride = 1;
  for (const std::size_t size : axis_sizes_) {
    const std::size_t at = number / stride % size;
    if (at > 0 && costs[number - stride] < costs[number]) return false;
    if (at + 1 < size && costs[number + stride] < costs[number]) return false;
    stride *= size;
  }
  return true;
}

/// Closer to one of `others` than about twice the distance of neighbouring points.
bool Scan::is_near_any(std::span<const std::size_t> others, std::size_t number) const {
  const double near = 2 * std::pow(double(places_.size()), -1.0 / double(places_.front().size()));
  return std::any_of(others.begin(), others.end(), [&](std::size_t other) {
    double distance = 0;
    for (std::size_t d = 0; d < places_[number].size(); ++d) {
      distance = std::max(distance, std::abs(places_[number][d] - places_[other][d]));
    }
    return distance < near;
  });
}

}  // namespace gonio::fit
