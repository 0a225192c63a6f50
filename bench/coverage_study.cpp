#include "bench/coverage_study.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "table/parallel.h"

namespace gonio::bench {
namespace {

/// Realisations of recipes whose seeds differ never share their noise.
constexpr std::size_t most_fits = 1'000'000;

/// What a fit says of one unknown.
struct Estimate {
  double error;
  std::optional<double> stddev;
  bool held;  // the truth lies in the 95 % interval
};

struct Outcome {
  std::vector<Estimate> estimates;  // per unknown
  bool converged = false;
  bool switched = false;
};

double truth_of(const instrument::Recipe& recipe, const fit::Unknown& unknown) {
  return recipe.parameters.at(unknown.parameter).at(unknown.is_shape ? 0 : unknown.channel);
}

table::SampleTable realisation(const instrument::Recipe& recipe, bool sigma_is_known,
                               std::size_t k) {
  instrument::Recipe with_seed = recipe;
  with_seed.noise.seed = most_fits * recipe.noise.seed + k;
  with_seed.sigma_columns = sigma_is_known;
  return instrument::synthesize(with_seed);
}

Outcome fit_realisation(const instrument::Recipe& recipe, const brdf::Model& model,
                        const Estimator& estimator, std::size_t k) {
  const fit::FitResult result =
      fit::fit(model, realisation(recipe, estimator.sigma_is_known, k),
               {.metric = estimator.metric, .covariance = estimator.covariance, .threads = 1});
  Outcome outcome;
  outcome.converged = result.converged;
  outcome.switched = result.uncertainty.kind != estimator.expected;
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    const double truth = truth_of(recipe, result.unknowns[u]);
    const auto& interval = result.uncertainty.interval95[u];
    outcome.estimates.push_back(
        {.error = result.values[result.unknowns[u]] - truth,
         .stddev = result.uncertainty.stddev[u],
         .held = interval && interval->first <= truth && truth <= interval->second});
  }
  return outcome;
}

ParameterCoverage parameter_coverage(std::string name, double truth, double bound,
                                     std::span<const Outcome> outcomes, std::size_t unknown) {
  double sum = 0;
  double squares = 0;
  double pull_squares = 0;
  double stated = 0;
  double held = 0;
  for (const Outcome& outcome : outcomes) {
    const Estimate& estimate = outcome.estimates[unknown];
    const double error = estimate.error / bound;
    sum += error;
    squares += error * error;
    held += estimate.held ? 1 : 0;
    if (!estimate.stddev) continue;
    const double pull = estimate.error / *estimate.stddev;
    pull_squares += pull * pull;
    stated += 1;
  }
  const auto fits = double(outcomes.size());
  return {.name = std::move(name),
          .truth = truth,
          .bound = bound,
          .bias = sum / fits,
          .ratio = std::sqrt(squares / fits),
          .pull = stated > 0 ? std::sqrt(pull_squares / stated) : 0,
          .coverage = held / fits};
}

}  // namespace

MaterialCoverage study_coverage(const instrument::Recipe& recipe, std::span<const double> bounds,
                                const Estimator& estimator, std::size_t fits, int threads) {
  if (fits < 1 || fits > most_fits) {
    throw std::invalid_argument(
        fmt::format("{} fits of a material; expected 1 to {}", fits, most_fits));
  }
  const brdf::Model model(recipe.model);
  std::vector<Outcome> outcomes(fits);
  table::parallel_for(fits, threads, [&](std::size_t k) {
    outcomes[k] = fit_realisation(recipe, model, estimator, k);
  });

  MaterialCoverage material{.material = recipe.name,
                            .model = model.name(),
                            .samples = realisation(recipe, false, 0).size(),
                            .fits = fits,
                            .not_converged = 0,
                            .switched = 0,
                            .parameters = {}};
  for (const Outcome& outcome : outcomes) {
    material.not_converged += outcome.converged ? 0 : 1;
    material.switched += outcome.switched ? 1 : 0;
  }
  const std::vector<fit::Unknown> unknowns = fit::unknowns_of(model, recipe.channels);
  for (std::size_t u = 0; u < unknowns.size(); ++u) {
    material.parameters.push_back(parameter_coverage(
        unknowns[u].name, truth_of(recipe, unknowns[u]), bounds[u], outcomes, u));
  }
  return material;
}

CoverageTotals sum_up(std::span<const MaterialCoverage> materials) {
  CoverageTotals totals;
  const Place first{&materials.front(), &materials.front().parameters.front()};
  totals.largest_ratio = totals.least_coverage = totals.largest_coverage = first;
  std::size_t parameters = 0;
  for (const MaterialCoverage& material : materials) {
    totals.fits += material.fits;
    totals.not_converged += material.not_converged;
    totals.switched += material.switched;
    totals.intervals += material.fits * material.parameters.size();
    parameters += material.parameters.size();
    for (const ParameterCoverage& parameter : material.parameters) {
      const Place place{&material, &parameter};
      totals.mean_ratio += parameter.ratio;
      totals.pooled_coverage += parameter.coverage * double(material.fits);
      if (parameter.ratio > totals.largest_ratio.parameter->ratio) totals.largest_ratio = place;
      if (parameter.coverage < totals.least_coverage.parameter->coverage) {
        totals.least_coverage = place;
      }
      if (parameter.coverage > totals.largest_coverage.parameter->coverage) {
        totals.largest_coverage = place;
      }
    }
  }
  totals.mean_ratio /= double(parameters);
  totals.pooled_coverage /= double(totals.intervals);
  return totals;
}

}  // namespace gonio::bench
