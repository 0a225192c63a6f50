// From a table to the parameters of a model, with error bars.
//
//   SampleTable table = table::read("brass.csv");
//   FitResult result = fit::fit(brdf::Model("ward-aniso"), table, {});
//
// Ceres moves the shape; the amplitudes are projected out (projection.h), and the table is
// compressed to a few rows (compression.h), so that the memory of a fit is the table plus a
// constant.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "brdf/model.h"
#include "fit/assessment.h"
#include "fit/options.h"
#include "fit/parameters.h"
#include "fit/uncertainty.h"
#include "table/sample_table.h"

namespace gonio::fit {

/// The errors of samples that a fit has not seen (held_out.h).
struct HeldOut {
  struct Fold {
    double lower_deg, upper_deg;  // the least and the largest incidence angle held out
    std::size_t values;           // over all channels
    double error;                 // like FitResult::metric_error
  };
  std::vector<Fold> folds;
  /// Of all the folds together.
  ErrorList errors;
  double metric_error;
};

/// A model beside a richer one that contains it (nested.h).
struct NestedComparison {
  std::string in;    // the richer model
  double statistic;  // of Wald's test, which the covariance scales to chi-square
  double p_value;
  std::string text;  // the verdict, in words
};

struct FitResult {
  brdf::Model model;
  std::vector<std::string> channels;
  Metric metric;
  Loss loss;
  /// Given, or found from the residuals; in the metric's unit. 0 without a robust loss.
  double loss_scale;
  /// All the unknowns in a row; `uncertainty` is indexed like it.
  std::vector<Unknown> unknowns;
  ParameterValues values;
  /// Other minima that were met on the way and that these data cannot tell from `values`.
  std::vector<ParameterValues> rivals;
  Uncertainty uncertainty;
  /// Half the weighted sum of squared residuals under the metric, or of what the loss makes of
  /// them.
  double cost;
  /// Root mean square of the residuals under the metric, weighted by the table and by the loss.
  double metric_error;
  ErrorList errors;
  /// With a robust loss: the values beyond outlier_threshold (5 standard deviations, as the median
  /// magnitude of the residuals tells them), the worst first; outlier_count may be more than are
  /// listed.
  double outlier_threshold;
  std::size_t outlier_count;
  std::vector<Outlier> outliers;
  /// Per basis function, how many samples it lives in (assessment.h).
  Eigen::VectorXd seen_by;
  /// Akaike's criterion with the correction for few values (Hurvich & Tsai 1989) and Schwarz's, of
  /// normal residuals with the known sigma; only under chi2, without a loss and weights.
  std::optional<double> aicc;
  std::optional<double> bic;
  /// Only where several models were compared.
  std::optional<HeldOut> held_out;
  std::optional<NestedComparison> nested;
  std::size_t samples;  // in the table
  std::size_t used;
  std::size_t used_values;  // over all channels
  bool converged;
  int iterations;  // of the solver, on the subset of the search and over the whole table
  int passes;      // over the whole table, all in all
  /// What a user should know before believing the numbers, one sentence each.
  std::vector<std::string> warnings;
};

/// Fits one model. Throws std::invalid_argument for options that do not fit the model or the table,
/// table::FileError if the table has too few samples for the unknowns. A fit that did not converge
/// is returned with converged = false.
FitResult fit(const brdf::Model& model, const table::SampleTable& table, const Options& options);

}  // namespace gonio::fit
