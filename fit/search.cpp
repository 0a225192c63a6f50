#include "fit/search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/amplitudes.h"
#include "fit/canonical.h"
#include "fit/compression.h"
#include "fit/joint_system.h"
#include "fit/projection.h"
#include "fit/robust_scale.h"
#include "fit/scan.h"
#include "fit/solve.h"
#include "fit/subset.h"
#include "fit/weighted_samples.h"
#include "table/parallel.h"

namespace gonio::fit {
namespace {

/// Samples that are scanned: enough to tell the basins apart.
constexpr std::size_t scanned_samples = 256;
/// A minimum whose cost on the subset is this much above the best one's cannot win on the table.
constexpr double hopeless_cost_ratio = 1.2;
/// In the scan neither the solution nor the subset is exact.
constexpr double hopeless_scan_ratio = 4;

/// Minima whose shapes differ by less are one.
constexpr double same_minimum = 2e-4;
/// Costs below this share of the data's are all that start_precision makes of 0.
constexpr double negligible_cost = 1e-9;

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
        project(compress(samples_, chunks_, model_, shape, false), model_, box_, false);
    return {projected.amplitudes, cost_of(projected.system)};
  }

  /// The loss with its scale, where it has to be found out: from the residuals at `values`.
  ScaledLoss loss_at(const ParameterValues& values) const {
    if (options_.loss == Loss::none) return {};
    if (options_.loss_scale) return {options_.loss, *options_.loss_scale};
    const double deviation =
        robust_deviation(samples_, model_, values, 0, least_deviation(samples_, model_, {}), {});
    return {options_.loss, efficient_scale(options_.loss) * deviation};
  }

  /// Solves from each start, and keeps the different ones that may still win, the best first.
  std::vector<Start> solve(const std::vector<Start>& starts, double hopeless_ratio) const {
    ScaledLoss loss = loss_at(starts.front().values);
    // Tukey's cost has many small minima; cauchy's is one wide basin, and its minimum a start.
    if (loss.loss == Loss::tukey) {
      loss = {Loss::cauchy,
              loss.scale * efficient_scale(Loss::cauchy) / efficient_scale(Loss::tukey)};
    }
    std::vector<Solution> solutions(starts.size());
    table::parallel_for(starts.size(), options_.threads, [&](std::size_t s) {
      solutions[s] =
          fit::solve(samples_, model_, box_, loss, starts[s].values, start_precision, {});
      solutions[s].iterations += starts[s].iterations;
      solutions[s].values = canonical(model_.model(), box_, std::move(solutions[s].values));
    });
    std::stable_sort(solutions.begin(), solutions.end(),
                     [](const Solution& a, const Solution& b) { return a.cost < b.cost; });
    const Solution& best = solutions.front();
    const double data = norm_of_data(best.system, best.values.amplitudes);
    const double hopeless = hopeless_ratio * std::max(best.cost, negligible_cost * data * data / 2);
    std::vector<Start> kept;
    for (const Solution& solution : solutions) {
      if (solution.cost > hopeless) break;
      if (std::none_of(kept.begin(), kept.end(), [&](const Start& other) {
            return largest_change(model_.model(), solution.values.shape, other.values.shape) <
                   same_minimum;
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
  std::vector<ShapeCost> points(scan.shapes().size());
  table::parallel_for(points.size(), threads,
                      [&](std::size_t i) { points[i] = level.at(scan.shapes()[i]); });
  std::vector<double> costs;
  for (const ShapeCost& point : points) costs.push_back(point.cost);
  std::vector<Start> starts;
  for (const std::size_t i : scan.minima(costs)) {
    starts.push_back({{scan.shapes()[i], points[i].amplitudes}, 0});
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
      coarse.solve(scan_minima(coarse, Scan(model.model(), box, options, false), options.threads),
                   hopeless_scan_ratio);
  if (!options.start.empty()) {
    // What the user gives is not judged by the thin part.
    const Scan given(model.model(), box, options, true);
    for (Start& start : scan_minima(coarse, given, options.threads)) {
      starts.push_back(std::move(start));
    }
  }
  return Level(subset, model, box, of_subset, floors).solve(starts, hopeless_cost_ratio);
}

}  // namespace gonio::fit
