#include "fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "fit/canonical.h"
#include "fit/diagnose.h"
#include "fit/robust_scale.h"
#include "fit/scale.h"
#include "fit/search.h"
#include "fit/solve.h"
#include "fit/subset.h"
#include "fit/weighted_samples.h"
#include "table/file_error.h"

namespace gonio::fit {
namespace {

/// Samples that the start is searched on: enough for every basin, few enough to be scanned.
constexpr std::size_t subset_samples = 2048;
/// Rounds of fitting and renewing sigma, or the loss' scale, from the fitted model.
constexpr int most_rounds = 20;
/// Standard deviations beyond which a residual is listed as an outlier: of 10 million normal ones
/// six are.
constexpr double outlier_deviations = 5;

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
void require_enough_values(const table::SampleTable& table, const Survey& survey,
                           std::span<const Unknown> unknowns) {
  const auto free_count = std::size_t(std::count_if(
      unknowns.begin(), unknowns.end(), [](const Unknown& u) { return !u.fixed && !u.dependent; }));
  if (survey.used_values < free_count) {
    throw table::FileError(
        fmt::format("{}: {} measured values in {} samples are left for {} unknowns; a fit needs "
                    "more samples than unknowns: fix some (--fix), take a simpler model, or raise "
                    "--max-theta",
                    table.provenance.path, survey.used_values, survey.used_samples, free_count));
  }
}

void check_options(const Options& options) {
  if (options.covariance == Covariance::known_sigma && options.metric != Metric::chi2) {
    throw std::invalid_argument(
        "covariance known-sigma needs residuals in units of sigma: choose metric chi2, or the "
        "residual or sandwich covariance");
  }
  if (options.loss != Loss::none && options.covariance != Covariance::automatic &&
      options.covariance != Covariance::sandwich) {
    throw std::invalid_argument(fmt::format(
        "covariance {} supposes normal residuals, which the loss {} does not: the sandwich "
        "covariance holds for it",
        name(options.covariance), name(options.loss)));
  }
  if (options.loss_scale) {
    if (options.loss == Loss::none) {
      throw std::invalid_argument("a loss scale needs a loss: huber, cauchy or tukey");
    }
    if (!(std::isfinite(*options.loss_scale) && *options.loss_scale > 0)) {
      throw std::invalid_argument(
          fmt::format("loss scale {}: a finite number above 0 is needed", *options.loss_scale));
    }
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

bool nearly_equal(const brdf::Model& model, const ParameterValues& a, const ParameterValues& b) {
  constexpr double tolerance = 1e-9;
  return largest_change(model, a.shape, b.shape) <= tolerance &&
         (a.amplitudes - b.amplitudes).norm() <= tolerance * b.amplitudes.norm();
}

/// What a solution needs besides the samples.
struct Problem {
  const BatchModel& model;
  const Box& box;
  const Options& options;
  const PassOptions& passes;
};

/// The shapes of minima differ by more.
constexpr double same_minimum = 1e-3;
/// Costs below this share of the data's are nothing but roundings.
constexpr double negligible_cost = 1e-16;
/// Costs that differ by less, in units of the residuals' variance, are the same at 95 %: half the
/// quantile of chi-square with one degree of freedom.
constexpr double same_cost = 1.92;

bool has_equal_terms(const brdf::Model& model) {
  const auto terms = model.terms();
  return std::any_of(terms.begin(), terms.end(), [&](const brdf::TermEntry* term) {
    return std::count(terms.begin(), terms.end(), term) > 1;
  });
}

/// The values of those solutions that are other minima than `best`, and as likely.
std::vector<ParameterValues> rivals_of(const Solution& best, std::span<const Solution> solutions,
                                       const WeightedSamples& samples, const brdf::Model& model) {
  const double variance =
      2 * best.cost / double(std::max<std::size_t>(samples.survey().used_values, 1));
  const double data = norm_of_data(best.system, best.values.amplitudes);
  const double most = best.cost + same_cost * variance + negligible_cost * data * data / 2;
  std::vector<ParameterValues> rivals;
  // Two terms of a kind may be exchanged, which makes no other material.
  if (has_equal_terms(model)) return rivals;
  for (const Solution& other : solutions) {
    if (other.cost > most) continue;
    const auto is_same = [&](const ParameterValues& values) {
      return largest_change(model, other.values.shape, values.shape) < same_minimum;
    };
    if (is_same(best.values) || std::any_of(rivals.begin(), rivals.end(), is_same)) continue;
    rivals.push_back(other.values);
  }
  return rivals;
}

Solution best_of(const WeightedSamples& samples, const Problem& problem, const ScaledLoss& loss,
                 std::span<const Start> starts) {
  std::vector<Solution> solutions;
  for (const Start& start : starts) {
    solutions.push_back(solve(samples, problem.model, problem.box, loss, start.values,
                              final_precision, problem.passes));
    solutions.back().iterations += start.iterations;
  }
  const auto find_best = [&] {
    return std::min_element(solutions.begin(), solutions.end(),
                            [](const Solution& a, const Solution& b) { return a.cost < b.cost; });
  };
  auto best = find_best();
  if (const auto twin = twin_of(problem.model.model(), problem.box, best->values)) {
    solutions.push_back(
        solve(samples, problem.model, problem.box, loss, *twin, final_precision, problem.passes));
    best = find_best();
  }
  best->rivals = rivals_of(*best, solutions, samples, problem.model.model());
  return std::move(*best);
}

Solution solved_again(const WeightedSamples& samples, const Problem& problem,
                      const ScaledLoss& loss, const Solution& before) {
  Solution solution = solve(samples, problem.model, problem.box, loss, before.values,
                            final_precision, problem.passes);
  solution.iterations += before.iterations;
  solution.rivals = before.rivals;
  return solution;
}

/// The scale follows from the residuals, and they from the scale: a few rounds settle both.
class ScaleSearch {
 public:
  explicit ScaleSearch(double first) : scale_(first) {}

  double scale() const { return scale_; }
  /// `found` is the scale of the residuals that scale() leads to. True if it is the same.
  bool is_settled(double found) {
    // Far below what the median is uncertain by; and with tukey, whose cost has many small folds, a
    // smaller change of the scale may throw the residuals to and fro.
    constexpr double tolerance = 1e-3;
    const double change = found - scale_;
    if (std::abs(change) <= tolerance * found) return true;
    // The secant through this change and the one before, where it is sane.
    double next = found;
    if (previous_) {
      const double slope = (change - previous_->second) / (scale_ - previous_->first);
      const double secant = scale_ - change / slope;
      if (secant > 0.5 * scale_ && secant < 2 * scale_) next = secant;
    }
    previous_ = {scale_, change};
    scale_ = next;
    return false;
  }

 private:
  double scale_;
  std::optional<std::pair<double, double>> previous_;  // a scale and its change
};

/// The loss with a scale that is found out, and what the search for it goes on from.
class FoundLoss {
 public:
  FoundLoss(const WeightedSamples& samples, const Problem& problem)
      : problem_(problem), least_(least_deviation(samples, problem.model, problem.passes)) {}

  /// The scale that the residuals at `values` have.
  double scale_at(const WeightedSamples& samples, const ParameterValues& values) {
    deviation_ =
        robust_deviation(samples, problem_.model, values, deviation_, least_, problem_.passes);
    return efficient_scale(problem_.options.loss) * deviation_;
  }

  /// Solves and renews the scale until both are settled, from `solution` and its scale.
  void settle(const WeightedSamples& samples, ScaledLoss& loss, Solution& solution) {
    ScaleSearch search(loss.scale);
    bool settled = search.is_settled(scale_at(samples, solution.values));
    for (int round = 0; round < most_rounds && !settled; ++round) {
      loss.scale = search.scale();
      solution = solved_again(samples, problem_, loss, solution);
      settled = search.is_settled(scale_at(samples, solution.values));
    }
    solution.converged = solution.converged && settled;
  }

 private:
  const Problem& problem_;
  double least_;
  double deviation_ = 0;
};

Solution solve_with_found_scale(const WeightedSamples& samples, const Problem& problem,
                                std::span<const Start> starts, FoundLoss& found, ScaledLoss& loss) {
  loss.scale = found.scale_at(samples, starts.front().values);
  Solution solution = best_of(samples, problem, loss, starts);
  found.settle(samples, loss, solution);
  if (starts.size() == 1) return solution;
  // Which start leads to the best minimum may have changed with the scale.
  Solution other = best_of(samples, problem, loss, starts);
  if (other.cost < (1 - 1e-6) * solution.cost) {
    other.iterations += solution.iterations;
    solution = std::move(other);
    found.settle(samples, loss, solution);
  }
  return solution;
}

/// sigma depends on the model, and the model on sigma, and so does a scale that is found out: a few
/// rounds settle them. `samples` are left with the sigma of `reference`.
void settle_noise(const table::SampleTable& table, const Problem& problem, FoundLoss* found,
                  ScaledLoss& loss, std::optional<WeightedSamples>& samples,
                  ParameterValues& reference, Solution& solution) {
  const Survey survey = samples->survey();
  bool settled = false;
  for (int round = 0; round < most_rounds && !settled; ++round) {
    reference = solution.values;
    samples.emplace(table, problem.model, problem.options, survey, std::span<const double>(),
                    &reference);
    solution = solved_again(*samples, problem, loss, solution);
    const double scale = loss.scale;
    if (found != nullptr) found->settle(*samples, loss, solution);
    settled =
        scale == loss.scale && nearly_equal(problem.model.model(), reference, solution.values);
  }
  solution.converged = solution.converged && settled;
}

/// What the solver took for 0 becomes 0.
void clear_least_roots(const brdf::Model& model, const Box& box, ParameterValues& values) {
  for (std::size_t j = 0; j < values.shape.size(); ++j) {
    if (model.shape()[j].descriptor.scale == brdf::Scale::quadratic && box.shape_lower[j] == 0 &&
        values.shape[j] <= least_root) {
      values.shape[j] = 0;
    }
  }
}

/// The criteria of models of one table, from -2 ln of the likelihood.
void add_criteria(const Assessment& assessment, const Identifiability& identifiability,
                  const WeightedSamples& samples, FitResult& result) {
  if (result.metric != Metric::chi2 || result.loss != Loss::none || samples.has_weight()) return;
  const double k = double(identifiability.rank());
  const double n = double(result.used_values);
  const double deviance = 2 * result.cost + assessment.log_variance;
  result.bic = deviance + k * std::log(n);
  if (n > k + 1) result.aicc = deviance + 2 * k + 2 * k * (k + 1) / (n - k - 1);
}

}  // namespace

FitResult fit(const brdf::Model& model, const table::SampleTable& table, const Options& options) {
  const BatchModel batch(model);
  check_options(options);
  const Box box = box_of(model, table.channels, options);
  std::vector<Unknown> unknowns = unknowns_of(model, table.channels);
  mark_unknowns(box, unknowns);
  PassCounter passes(options.threads, options.progress);
  const Problem problem{batch, box, options, passes.options()};

  const table::SampleFilter filter(table, options.max_theta_deg, options.incidence);
  const Survey survey = survey_of(table, filter, options.threads);
  require_enough_values(table, survey, unknowns);
  const std::vector<double> floors = relative_floors(table, filter, options.threads);
  std::optional<WeightedSamples> samples(std::in_place, table, batch, options, survey, floors);
  const table::SampleTable subset =
      representative_subset(table, filter, survey.used_samples, subset_samples, options.threads);
  const std::vector<Start> starts = search_starts(subset, batch, box, options, floors);

  ScaledLoss loss{options.loss, options.loss_scale.value_or(1)};
  std::optional<FoundLoss> found;
  if (options.loss != Loss::none && !options.loss_scale) found.emplace(*samples, problem);
  Solution solution = found ? solve_with_found_scale(*samples, problem, starts, *found, loss)
                            : best_of(*samples, problem, loss, starts);
  ParameterValues reference;
  if (options.metric == Metric::chi2 && options.noise && options.noise->relative > 0) {
    settle_noise(table, problem, found ? &*found : nullptr, loss, samples, reference, solution);
  }

  // The whole table may have carried the subset's solution over to the other description.
  const ParameterValues described = canonical(model, box, solution.values);
  if (described.shape != solution.values.shape) {
    solution.values = described;
    solution = solved_again(*samples, problem, loss, solution);
  }

  const Identifiability identifiability(solution.system, model, box, solution.values, unknowns);
  Uncertainty uncertainty = uncertainty_kind(solution, identifiability, *samples, options);
  AssessmentOptions assessment_options{.loss = loss,
                                       .scores = uncertainty.kind == Covariance::sandwich};
  if (options.loss != Loss::none) {
    assessment_options.outlier_threshold =
        outlier_deviations * loss.scale / efficient_scale(options.loss);
  }
  Assessment assessment = assess(*samples, batch, solution.values, unknowns, floors,
                                 assessment_options, passes.options());
  complete_uncertainty(solution, identifiability, *samples, model, box, unknowns, assessment,
                       uncertainty);

  FitResult result{.model = model,
                   .channels = table.channels,
                   .metric = options.metric,
                   .loss = options.loss,
                   .loss_scale = options.loss == Loss::none ? 0 : loss.scale,
                   .unknowns = unknowns,
                   .values = solution.values,
                   .rivals = std::move(solution.rivals),
                   .uncertainty = std::move(uncertainty),
                   .cost = solution.cost,
                   .metric_error = assessment.metric_error,
                   .errors = std::move(assessment.errors),
                   .outlier_threshold = assessment_options.outlier_threshold,
                   .outlier_count = assessment.outlier_count,
                   .outliers = std::move(assessment.outliers),
                   .seen_by = std::move(assessment.seen_by),
                   .aicc = {},
                   .bic = {},
                   .held_out = {},
                   .nested = {},
                   .samples = table.size(),
                   .used = survey.used_samples,
                   .used_values = survey.used_values,
                   .converged = solution.converged,
                   .iterations = solution.iterations,
                   .passes = passes.count(),
                   .warnings = {}};
  add_criteria(assessment, identifiability, *samples, result);
  clear_least_roots(model, box, result.values);
  result.warnings = diagnose(result, box, identifiability, survey);
  return result;
}

}  // namespace gonio::fit
