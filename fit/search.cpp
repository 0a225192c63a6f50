#include "fit/search.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fit/compression.h"
#include "fit/projection.h"
#include "fit/solve.h"
#include "fit/weighted_samples.h"
#include "table/parallel.h"

namespace gonio::fit {
namespace {

/// Minima of the scan that are solved for.
constexpr std::size_t most_minima = 4;
/// A minimum whose cost on the subset is this much above the best one's cannot win on the table.
constexpr double hopeless_cost_ratio = 1.2;

/// Points per dimension: a basin of attraction in a roughness spans about a factor of two.
std::size_t points_per_axis(std::size_t dimensions) {
  return dimensions == 1 ? 24 : dimensions == 2 ? 12 : 6;
}

struct Axis {
  std::vector<double> points;
};

Axis axis_between(double lower, double upper, brdf::Scale scale, std::size_t count) {
  Axis axis;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = double(i) / double(count - 1);
    axis.points.push_back(scale == brdf::Scale::logarithmic ? lower * std::pow(upper / lower, t)
                                                            : lower + t * (upper - lower));
    axis.points.back() = std::clamp(axis.points.back(), lower, upper);
  }
  return axis;
}

std::optional<double> start_of(const std::string& name, const Options& options) {
  std::optional<double> value;
  for (const ParameterSetting& setting : options.start) {
    if (setting.parameter == name) value = setting.value;
  }
  return value;
}

std::vector<Axis> scan_axes(const brdf::Model& model, const Box& box, const Options& options) {
  std::vector<std::optional<double>> known(model.shape().size());
  std::size_t unknown_count = 0;
  for (std::size_t j = 0; j < known.size(); ++j) {
    known[j] = box.shape_lower[j] == box.shape_upper[j] ? std::optional(box.shape_lower[j])
                                                        : start_of(model.shape()[j].name, options);
    if (!known[j]) ++unknown_count;
  }
  std::vector<Axis> axes;
  for (std::size_t j = 0; j < known.size(); ++j) {
    if (known[j]) {
      axes.push_back({{*known[j]}});
      continue;
    }
    const brdf::Parameter& descriptor = model.shape()[j].descriptor;
    const double lower =
        std::clamp(descriptor.search_lower, box.shape_lower[j], box.shape_upper[j]);
    const double upper =
        std::clamp(descriptor.search_upper, box.shape_lower[j], box.shape_upper[j]);
    axes.push_back(
        lower < upper ? axis_between(lower, upper, descriptor.scale, points_per_axis(unknown_count))
                      : Axis{{lower}});
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

bool same_minimum(const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t j = 0; j < a.size(); ++j) {
    if (std::abs(a[j] - b[j]) > 1e-4 * (std::abs(a[j]) + std::abs(b[j]))) return false;
  }
  return true;
}

}  // namespace

table::SampleTable representative_subset(const table::SampleTable& table,
                                         const table::SampleFilter& filter,
                                         std::size_t used_samples, std::size_t count) {
  table::SampleTable subset;
  subset.channels = table.channels;
  subset.provenance = table.provenance;
  subset.values.resize(table.values.size());
  subset.sigma.resize(table.sigma.size());
  const auto take = [&](std::size_t i, double weight) {
    subset.wi.push_back(table.wi[i]);
    subset.wo.push_back(table.wo[i]);
    for (std::size_t c = 0; c < table.values.size(); ++c) {
      subset.values[c].push_back(table.values[c][i]);
    }
    for (std::size_t c = 0; c < table.sigma.size(); ++c) {
      subset.sigma[c].push_back(table.sigma[c][i]);
    }
    subset.mask.push_back(table::MaskReason::none);
    subset.weight.push_back(weight * (table.has_weight() ? table.weight[i] : 1));
  };
  const auto brightness = [&](std::size_t i) {
    double sum = 0;
    for (const std::vector<double>& channel : table.values) {
      if (!std::isnan(channel[i])) sum += std::abs(channel[i]);
    }
    return sum * table.wi.z[i];
  };

  // Runs of `length` used samples give two samples each.
  const std::size_t length =
      used_samples <= count ? 1 : (2 * used_samples + count - 1) / std::max<std::size_t>(count, 1);
  std::vector<std::size_t> run;
  std::size_t run_number = 0;
  const auto take_run = [&] {
    if (run.empty()) return;
    const auto brightest = std::max_element(
        run.begin(), run.end(),
        [&](std::size_t a, std::size_t b) { return brightness(a) < brightness(b); });
    std::iter_swap(run.begin(), brightest);
    take(run.front(), 1);
    // The golden ratio's multiples spread over the runs evenly and without a period.
    const double spread = std::fmod(double(++run_number) * 0.6180339887498949, 1.0);
    if (run.size() > 1) {
      const std::size_t others = run.size() - 1;
      take(run[1 + std::size_t(spread * double(others))], double(others));
    }
    run.clear();
  };
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!filter(i)) continue;
    run.push_back(i);
    if (run.size() == length) take_run();
  }
  take_run();
  return subset;
}

std::vector<Start> search_starts(const table::SampleTable& subset, const BatchModel& model,
                                 const Box& box, const Options& options) {
  const Grid grid{scan_axes(model.model(), box, options)};
  if (grid.size() == 1) return {{grid.shape(0), 0}};

  const WeightedSamples samples(subset, model, options);
  std::vector<double> costs(grid.size());
  table::parallel_for(grid.size(), options.threads, [&](std::size_t g) {
    const Compressed compressed = compress(samples, model, grid.shape(g), false, {});
    costs[g] = project(compressed, model, box, false).cost();
  });
  std::vector<std::size_t> minima;
  for (std::size_t g = 0; g < grid.size(); ++g) {
    if (grid.is_minimum(g, costs)) minima.push_back(g);
  }
  std::sort(minima.begin(), minima.end(),
            [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  minima.resize(std::min(minima.size(), most_minima));

  std::vector<Solution> solutions(minima.size());
  table::parallel_for(minima.size(), options.threads, [&](std::size_t m) {
    solutions[m] = solve(samples, model, box, grid.shape(minima[m]), {});
  });
  std::sort(solutions.begin(), solutions.end(),
            [](const Solution& a, const Solution& b) { return a.cost < b.cost; });
  std::vector<Start> starts;
  for (const Solution& solution : solutions) {
    if (solution.cost > hopeless_cost_ratio * solutions.front().cost) break;
    const auto& shape = solution.values.shape;
    if (std::none_of(starts.begin(), starts.end(),
                     [&](const Start& other) { return same_minimum(shape, other.shape); })) {
      starts.push_back({shape, solution.iterations});
    }
  }
  return starts;
}

}  // namespace gonio::fit
