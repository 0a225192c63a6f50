#include "fit/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "fit/amplitudes.h"
#include "fit/canonical.h"
#include "fit/compression.h"
#include "fit/joint_system.h"
#include "fit/projection.h"
#include "fit/robust_scale.h"
#include "fit/solve.h"
#include "fit/subset.h"
#include "fit/weighted_samples.h"
#include "table/parallel.h"

namespace gonio::fit {
namespace {

/// Samples that are scanned: enough to tell the basins apart.
constexpr std::size_t scanned_samples = 512;
/// A minimum whose cost on the subset is this much above the best one's cannot win on the table.
constexpr double hopeless_cost_ratio = 1.2;
/// In the scan neither the solution nor the subset is exact.
constexpr double hopeless_scan_ratio = 4;

/// Up to two dimensions are scanned on a grid: a basin of attraction in a roughness spans about a
/// factor of two. More are scanned at scattered points.
std::size_t points_per_axis(std::size_t dimensions) { return dimensions == 1 ? 24 : 12; }
std::size_t scattered_points(std::size_t dimensions) { return std::size_t(256) << dimensions; }
std::size_t most_minima(std::size_t dimensions) { return dimensions <= 2 ? 4 : 10; }

struct Axis {
  std::vector<double> points;
};

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

/// The point at the share `t` of the way through a range.
double point_between(double lower, double upper, brdf::Scale scale, double t) {
  return std::clamp(scale == brdf::Scale::logarithmic ? lower * std::pow(upper / lower, t)
                                                      : lower + t * (upper - lower),
                    lower, upper);
}

std::vector<Axis> scan_axes(const brdf::Model& model, const Box& box,
                            std::span<const std::optional<double>> known, std::size_t count) {
  std::vector<Axis> axes;
  for (std::size_t j = 0; j < known.size(); ++j) {
    Axis axis;
    const auto [lower, upper] = search_range(model, box, j);
    for (std::size_t i = 0; !known[j] && i < count; ++i) {
      axis.points.push_back(point_between(lower, upper, model.shape()[j].descriptor.scale,
                                          double(i) / double(count - 1)));
    }
    if (known[j]) axis.points = {*known[j]};
    axes.push_back(std::move(axis));
  }
  return axes;
}

/// A point of the product of the axes by its number.
struct Grid {
  std::vector<Axis> axes;

  std::size_t size() const {
    std::size_t count = 1;
    for (const Axis& axis : axes) count *= axis.points.size();
    return count;
  }

  std::vector<double> shape(std::size_t number) const {
    std::vector<double> result;
    for (const Axis& axis : axes) {
      result.push_back(axis.points[number % axis.points.size()]);
      number /= axis.points.size();
    }
    return result;
  }

  /// No neighbour along an axis is lower.
  bool is_minimum(std::size_t number, std::span<const double> costs) const {
    std::size_t stride = 1;
    for (const Axis& axis : axes) {
      const std::size_t at = number / stride % axis.points.size();
      if (at > 0 && costs[number - stride] < costs[number]) return false;
      if (at + 1 < axis.points.size() && costs[number + stride] < costs[number]) return false;
      stride *= axis.points.size();
    }
    return true;
  }
};

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
          point_between(lower, upper, model.shape()[j].descriptor.scale, places[i].back()));
    }
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

/// The shapes that are scanned, and which of them are worth a solution once their costs are known.
struct Scan {
  std::size_t most_minima;
  std::vector<std::vector<double>> shapes;
  Grid grid;                                // empty where the points are scattered
  std::vector<std::vector<double>> places;  // of scattered points

  /// The best first.
  std::vector<std::size_t> minima(std::span<const double> costs) const {
    std::vector<std::size_t> order(shapes.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
    std::vector<std::size_t> found;
    for (const std::size_t i : order) {
      if (found.size() == most_minima) break;
      if (places.empty() ? grid.is_minimum(i, costs) : !is_near_any(found, i)) found.push_back(i);
    }
    return found;
  }

 private:
  /// Closer to one of `others` than about twice the distance of neighbouring points.
  bool is_near_any(std::span<const std::size_t> others, std::size_t i) const {
    const double near = 2 * std::pow(double(places.size()), -1.0 / double(places.front().size()));
    return std::any_of(others.begin(), others.end(), [&](std::size_t other) {
      double distance = 0;
      for (std::size_t d = 0; d < places[i].size(); ++d) {
        distance = std::max(distance, std::abs(places[i][d] - places[other][d]));
      }
      return distance < near;
    });
  }
};

Scan scan_of(const brdf::Model& model, const Box& box, const Options& options, bool with_start) {
  const std::vector<std::optional<double>> known = known_shape(model, box, options, with_start);
  const auto dimensions = std::size_t(std::count(known.begin(), known.end(), std::nullopt));
  Scan scan{most_minima(dimensions), {}, {}, {}};
  if (dimensions > 2) {
    scan.shapes = scattered_shapes(model, box, known, scattered_points(dimensions), scan.places);
    return scan;
  }
  scan.grid = {scan_axes(model, box, known, points_per_axis(dimensions))};
  for (std::size_t i = 0; i < scan.grid.size(); ++i) scan.shapes.push_back(scan.grid.shape(i));
  return scan;
}

bool same_minimum(const ParameterValues& a, const ParameterValues& b) {
  for (std::size_t j = 0; j < a.shape.size(); ++j) {
    if (std::abs(a.shape[j] - b.shape[j]) > 1e-4 * (std::abs(a.shape[j]) + std::abs(b.shape[j]))) {
      return false;
    }
  }
  return true;
}

/// A part of the table, and everything that is needed to solve the problem there.
class Level {
 public:
  Level(const table::SampleTable& table, const BatchModel& model, const Box& box,
        const Options& options, std::span<const double> floors)
      : model_(model),
        box_(box),
        options_(options),
        samples_(table, model, options,
                 survey_of(table, table::SampleFilter(table, options.max_theta_deg), 1), floors) {
    for (std::size_t i = 0; i < samples_.chunk_count(); ++i) {
      chunks_.emplace_back(samples_.channel_count());
      samples_.gather(i, chunks_.back());
    }
  }

  /// The best amplitudes at a shape, as well as a start needs them.
  ShapeCost at(const std::vector<double>& shape) const {
    if (!is_projectable(options_.metric, options_.loss)) {
      return best_amplitudes(samples_, chunks_, model_, box_, shape, options_.loss);
    }
    const Projected projected =
        project(compress(samples_, model_, shape, false, {}), model_, box_, false);
    return {projected.amplitudes, cost_of(projected.system)};
  }

  /// The loss with its scale, where it has to be found out: from the residuals at `values`.
  ScaledLoss loss_at(const ParameterValues& values) const {
    if (options_.loss == Loss::none) return {};
    if (options_.loss_scale) return {options_.loss, *options_.loss_scale};
    const double deviation =
        std::max(robust_deviation(samples_, model_, values, 0, {}), least_deviation(samples_, {}));
    return {options_.loss, efficient_scale(options_.loss) * deviation};
  }

  /// Solves from each start, and keeps the different ones that may still win, the best first.
  std::vector<Start> solve(const std::vector<Start>& starts, double hopeless_ratio) const {
    const ScaledLoss loss = loss_at(starts.front().values);
    std::vector<Solution> solutions(starts.size());
    table::parallel_for(starts.size(), options_.threads, [&](std::size_t s) {
      solutions[s] = fit::solve(samples_, model_, box_, loss, starts[s].values, {});
      solutions[s].iterations += starts[s].iterations;
      solutions[s].values = canonical(model_.model(), box_, std::move(solutions[s].values));
    });
    std::stable_sort(solutions.begin(), solutions.end(),
                     [](const Solution& a, const Solution& b) { return a.cost < b.cost; });
    std::vector<Start> kept;
    for (const Solution& solution : solutions) {
      if (solution.cost > hopeless_ratio * solutions.front().cost) break;
      if (std::none_of(kept.begin(), kept.end(), [&](const Start& other) {
            return same_minimum(solution.values, other.values);
          })) {
        kept.push_back({solution.values, solution.iterations});
      }
    }
    return kept;
  }

 private:
  const BatchModel& model_;
  const Box& box_;
  const Options& options_;
  WeightedSamples samples_;
  std::vector<SampleChunk> chunks_;
};

/// The minima of a scan, the best first.
std::vector<Start> scan_minima(const Level& level, const Scan& scan, int threads) {
  std::vector<ShapeCost> points(scan.shapes.size());
  table::parallel_for(points.size(), threads,
                      [&](std::size_t i) { points[i] = level.at(scan.shapes[i]); });
  std::vector<double> costs;
  for (const ShapeCost& point : points) costs.push_back(point.cost);
  std::vector<Start> starts;
  for (const std::size_t i : scan.minima(costs)) {
    starts.push_back({{scan.shapes[i], points[i].amplitudes}, 0});
  }
  return starts;
}

}  // namespace

std::vector<Start> search_starts(const table::SampleTable& subset, const BatchModel& model,
                                 const Box& box, const Options& options,
                                 std::span<const double> floors) {
  // The subset holds only samples that passed the filter.
  Options of_subset = options;
  of_subset.incidence.reset();
  const table::SampleTable thin =
      representative_subset(subset, table::SampleFilter(subset, options.max_theta_deg),
                            subset.size(), scanned_samples, 1);
  const Level coarse(thin, model, box, of_subset, floors);
  std::vector<Start> starts =
      scan_minima(coarse, scan_of(model.model(), box, options, false), options.threads);
  if (!options.start.empty()) {
    const Scan given = scan_of(model.model(), box, options, true);
    for (Start& start : scan_minima(coarse, given, options.threads)) {
      starts.push_back(std::move(start));
    }
  }
  starts = coarse.solve(starts, hopeless_scan_ratio);
  return Level(subset, model, box, of_subset, floors).solve(starts, hopeless_cost_ratio);
}

}  // namespace gonio::fit
