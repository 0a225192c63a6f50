// How honest error bars are: a material is measured many times with fresh noise, and fitted each
// time. An efficient estimate errs by its Cramer-Rao bound in the root mean square, and an honest
// 95 % interval holds the truth in 95 % of the fits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fit/options.h"
#include "instrument/recipe.h"

namespace gonio::bench {

struct Band {
  double lower, upper;
  bool holds(double value) const { return lower <= value && value <= upper; }
};

/// Fits of each material that the figures are meant for: fewer scatter more.
inline constexpr std::size_t fits_of_the_figures = 2000;

/// What the project promises of an estimator.
struct Figures {
  /// RMS error over Cramer-Rao bound: of each parameter, and the mean of all.
  std::optional<double> largest_ratio, largest_mean_ratio;
  /// The share of 95 % intervals that hold the truth: of each parameter, and of all together.
  Band coverage, pooled_coverage;
};

/// A way to fit, and what it promises.
struct Estimator {
  std::string_view name;
  fit::Metric metric;
  fit::Covariance covariance;
  /// The covariance that the fit has to arrive at.
  fit::Covariance expected;
  /// Whether the table states sigma.
  bool sigma_is_known;
  Figures figures;
};

inline constexpr Estimator known_sigma{
    .name = "known sigma, chi2",
    .metric = fit::Metric::chi2,
    .covariance = fit::Covariance::automatic,
    .expected = fit::Covariance::known_sigma,
    .sigma_is_known = true,
    .figures = {.largest_ratio = 1.1,
                .largest_mean_ratio = 1.03,
                .coverage = {0.93, 0.97},
                .pooled_coverage = {0.945, 0.955}},
};
inline constexpr Estimator noise_not_told{
    .name = "noise not told, cosine-l2, sandwich",
    .metric = fit::Metric::cosine_l2,
    .covariance = fit::Covariance::sandwich,
    .expected = fit::Covariance::sandwich,
    .sigma_is_known = false,
    .figures = {.largest_ratio = {},
                .largest_mean_ratio = {},
                .coverage = {0.92, 0.98},
                .pooled_coverage = {0.935, 0.965}},
};

/// One scalar parameter over all fits of a material.
struct ParameterCoverage {
  std::string name;
  double truth;
  /// The Cramer-Rao bound, in the unit of the parameter.
  double bound;
  /// Mean error, and root mean square error, over the bound.
  double bias, ratio;
  /// Root mean square of the errors over the standard deviations that the fits state: 1 if those
  /// are honest. 0 if no fit states one.
  double pull;
  /// Share of the fits whose 95 % interval holds the truth; a fit without one does not.
  double coverage;
};

struct MaterialCoverage {
  std::string material;
  std::string model;
  std::size_t samples;
  std::size_t fits;
  std::size_t not_converged;
  /// Fits that took another covariance than the expected one.
  std::size_t switched;
  std::vector<ParameterCoverage> parameters;
};

/// Synthesizes and fits `recipe` with its true model `fits` times; realisation k, from 0, has the
/// noise seed 1,000,000 * recipe.noise.seed + k. `bounds` as of cramer_rao_bounds(). The result is
/// the same for any number of threads (0: as many as the machine has). Throws std::invalid_argument
/// unless 1 <= fits <= 1,000,000.
MaterialCoverage study_coverage(const instrument::Recipe& recipe, std::span<const double> bounds,
                                const Estimator& estimator, std::size_t fits, int threads);

/// A parameter of a material.
struct Place {
  const MaterialCoverage* material;
  const ParameterCoverage* parameter;
};

/// A study's materials summed up. The places point into them.
struct CoverageTotals {
  std::size_t fits = 0, not_converged = 0, switched = 0;
  /// Parameters times fits.
  std::size_t intervals = 0;
  double mean_ratio = 0;
  double pooled_coverage = 0;
  Place largest_ratio{}, least_coverage{}, largest_coverage{};
};

/// Of at least one material.
CoverageTotals sum_up(std::span<const MaterialCoverage> materials);

}  // namespace gonio::bench
