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

/// Throws if there are fewer values than unknowns.
void require_enough_values(const WeightedSamples& samples, std::span<const Unknown> unknowns) {
  const auto free_count = std::size_t(
      std::count_if(unknowns.begin(), unknowns.end(), [](const Unknown& u) { return !u.fixed; }));
  if (samples.used_values() < free_count) {
    throw table::FileError(
        fmt::format("{}: {} measured values in {} samples are left for {} unknowns; a fit needs "
                    "more samples than unknowns: fix some (--fix), take a simpler model, or raise "
                    "--max-theta",
                    samples.table().provenance.path, samples.used_values(), samples.used_samples(),
                    free_count));
  }
}

/// Throws if the values are so large or so small that their squares leave the range of double.
void require_representable_squares(const table::SampleTable& table,
                                   const table::SampleFilter& filter) {
  double largest = 0;
  for (const std::vector<double>& channel : table.values) {
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (!std::isnan(channel[i]) && filter(i)) largest = std::max(largest, std::abs(channel[i]));
    }
  }
  if (largest == 0 || (largest > 1e-100 && largest < 1e100)) return;
  throw table::FileError(
      fmt::format("{}: the largest magnitude of f_r is {:.3g} 1/sr, which no material has; values "
                  "between 1e-100 and 1e100 can be fitted: check the table's unit and quantity",
                  table.provenance.path, largest));
}

void check_options(const Options& options) {
  if (options.covariance == Covariance::known_sigma && options.metric != Metric::chi2) {
    throw std::invalid_argument(
        "covariance known-sigma needs residuals in units of sigma: choose metric chi2, or the "
        "residual or sandwich covariance");
  }
  if (!options.noise) return;
  const Noise& noise = *options.noise;
  if (!(std::isfinite(noise.relative) && std::isfinite(noise.absolute) && noise.relative >= 0 &&
        noise.absolute >= 0 && noise.relative + noise.absolute > 0)) {
    throw std::invalid_argument(
        fmt::format("noise {},{}: two finite numbers are needed, not negative and not both 0",
                    noise.relative, noise.absolute));
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
double metric_error_of(const FitResult& result) {
  for (const auto& [metric, error] : result.errors) {
    if (metric == name(result.metric)) return error;
  }
  return std::sqrt(2 * result.cost / double(result.used_values));
}

}  // namespace

FitResult fit(const brdf::Model& model, const table::SampleTable& table, const Options& options) {
  const BatchModel batch(model);
  check_options(options);
  std::vector<Unknown> unknowns = unknowns_of(model, table.channels);
  const Box box = box_of(model, table.channels, options);
  for (Unknown& unknown : unknowns) unknown.fixed = box.is_fixed(unknown);
  PassCounter passes(options.threads, options.progress);

  std::optional<WeightedSamples> samples(std::in_place, table, batch, options);
  require_enough_values(*samples, unknowns);
  require_representable_squares(table, samples->filter());
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
      .used_values = samples->used_values(),
      .converged = solution.converged,
      .iterations = solution.iterations,
      .passes = 0,
      .warnings = {}};
  result.metric_error = metric_error_of(result);
  result.passes = passes.count();
  result.warnings = diagnose(result, box, identifiability);
  return result;
}

}  // namespace gonio::fit
