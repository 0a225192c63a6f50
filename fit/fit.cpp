#include "fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "fit/diagnose.h"
#include "fit/search.h"
#include "fit/solve.h"
#include "fit/weighted_samples.h"
#include "table/file_error.h"

namespace gonio::fit {
namespace {

/// Samples that the start is searched on: enough for every basin, few enough to be scanned.
constexpr std::size_t subset_samples = 2048;
/// Rounds of fitting and renewing sigma from the fitted model.
constexpr int most_noise_rounds = 10;

/// Counts the passes over the whole table and passes their progress on.
class PassCounter {
 public:
  PassCounter(int threads, const Progress& progress) {
    options_.threads = threads;
    options_.on_pass = [this, &progress]() -> std::function<void(double)> {
      ++count_;
      if (!progress) return nullptr;
      return [&progress, pass = count_](double share) { progress(pass, share); };
    };
  }
  PassCounter(const PassCounter&) = delete;
  PassCounter& operator=(const PassCounter&) = delete;

  const PassOptions& options() const { return options_; }
  int count() const { return count_; }

 private:
  int count_ = 0;
  PassOptions options_;
};

/// Throws unless every channel, and all together, have at least as many values as unknowns.
void require_enough_values(const WeightedSamples& samples, const Box& box,
                           std::span<const Unknown> unknowns) {
  const auto free_count = std::size_t(std::count_if(
      unknowns.begin(), unknowns.end(), [&](const Unknown& u) { return !box.is_fixed(u); }));
  if (samples.used_values() < free_count) {
    throw table::FileError(
        fmt::format("{}: {} measured values in {} samples are left for {} unknowns; a fit needs "
                    "more samples than unknowns: fix some (--fix), take a simpler model, or raise "
                    "--max-theta",
                    samples.table().provenance.path, samples.used_values(), samples.used_samples(),
                    free_count));
  }
}

Solution best_solution(const WeightedSamples& samples, const BatchModel& model, const Box& box,
                       std::span<const Start> starts, const PassOptions& passes) {
  std::optional<Solution> best;
  for (const Start& start : starts) {
    Solution solution = solve(samples, model, box, start.shape, passes);
    solution.iterations += start.iterations;
    if (!best || solution.cost < best->cost) best = std::move(solution);
  }
  return std::move(*best);
}

bool nearly_equal(const ParameterValues& a, const ParameterValues& b) {
  constexpr double tolerance = 1e-9;
  for (std::size_t j = 0; j < a.shape.size(); ++j) {
    if (std::abs(a.shape[j] - b.shape[j]) > tolerance * std::abs(b.shape[j])) return false;
  }
  return (a.amplitudes - b.amplitudes).norm() <= tolerance * b.amplitudes.norm();
}

/// The metric's own root mean square; in units of sigma for chi2.
double metric_error_of(const FitResult& result, std::size_t used_values) {
  for (const auto& [metric, error] : result.errors) {
    if (metric == name(result.metric)) return error;
  }
  return std::sqrt(2 * result.cost / double(used_values));
}

}  // namespace

FitResult fit(const brdf::Model& model, const table::SampleTable& table, const Options& options) {
  const BatchModel batch(model);
  const std::vector<Unknown> unknowns = unknowns_of(model, table.channels);
  const Box box = box_of(model, table.channels, options);
  PassCounter passes(options.threads, options.progress);

  std::optional<WeightedSamples> samples(std::in_place, table, batch, options);
  require_enough_values(*samples, box, unknowns);
  const table::SampleTable subset =
      representative_subset(table, samples->filter(), samples->used_samples(), subset_samples);
  const std::vector<Start> starts = search_starts(subset, batch, box, options);
  Solution solution = best_solution(*samples, batch, box, starts, passes.options());

  // sigma depends on the model, and the model on sigma: a few rounds settle both.
  ParameterValues reference;
  if (options.metric == Metric::chi2 && options.noise && options.noise->relative > 0) {
    bool settled = false;
    for (int round = 0; round < most_noise_rounds && !settled; ++round) {
      reference = solution.values;
      samples.emplace(table, batch, options, &reference);
      const int iterations = solution.iterations;
      solution = solve(*samples, batch, box, reference.shape, passes.options());
      solution.iterations += iterations;
      settled = nearly_equal(reference, solution.values);
    }
    solution.converged = solution.converged && settled;
  }

  const Identifiability identifiability(solution.compressed, batch, box, solution.values, unknowns);
  FitResult result{
      .model = model,
      .channels = table.channels,
      .metric = options.metric,
      .unknowns = unknowns,
      .values = solution.values,
      .uncertainty = uncertainty_of(solution, identifiability, *samples, batch, box, unknowns,
                                    options, passes.options()),
      .cost = solution.cost,
      .metric_error = 0,
      .errors = errors_of(table, options.max_theta_deg, batch, solution.values, passes.options()),
      .samples = table.size(),
      .used = samples->used_samples(),
      .converged = solution.converged,
      .iterations = solution.iterations,
      .passes = 0,
      .warnings = {}};
  result.metric_error = metric_error_of(result, samples->used_values());
  result.passes = passes.count();
  result.warnings = diagnose(result, box, identifiability);
  return result;
}

}  // namespace gonio::fit
