// How sure each parameter is: the covariance of all the unknowns from the Jacobian at the optimum.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fit/assessment.h"
#include "fit/linear_system.h"
#include "fit/options.h"
#include "fit/parameters.h"
#include "fit/solve.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {

/// What the directions of a table determine at given parameters: the singular value
/// decomposition of the full Jacobian (all unknowns that are not fixed), columns scaled to 1.
class Identifiability {
 public:
  Identifiability(const LinearSystem& system, const brdf::Model& model, const Box& box,
                  const ParameterValues& values, std::span<const Unknown> unknowns);

  /// Unknowns that only a common change of which the data does not see, one group for each
  /// such combination; a single one without any influence is a group of its own. Indices into the
  /// unknowns.
  const std::vector<std::vector<std::size_t>>& undetermined() const { return undetermined_; }
  bool is_undetermined(std::size_t unknown) const;
  /// The unknowns that the data determines: those that are not fixed, less the undetermined
  /// combinations.
  std::size_t rank() const { return free_.size() - undetermined_.size(); }
  /// True if the term's amplitudes are 0 to rounding in every channel: its shape means nothing.
  bool is_absent(std::size_t term) const { return absent_terms_[term]; }
  /// (J'J)^+ over all the unknowns, without the undetermined combinations; 0 in the rows and
  /// columns of fixed ones.
  const Eigen::MatrixXd& inverse() const { return inverse_; }
  /// The same of another symmetric matrix over all the unknowns, on the combinations that are
  /// determined; inverse() if it is not positive definite there.
  Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix) const;

 private:
  std::vector<std::size_t> free_;
  std::vector<std::vector<std::size_t>> undetermined_;
  std::vector<bool> absent_terms_;
  /// [unknown, combination]: each column changes the residuals by a unit vector, orthogonal to the
  /// others'.
  Eigen::MatrixXd determined_;
  Eigen::MatrixXd inverse_;
};

struct Uncertainty {
  /// Never automatic.
  Covariance kind = Covariance::residual;
  /// Per unknown; none where it is fixed or undetermined.
  std::vector<std::optional<double>> stddev;
  /// value -+ quantile times stddev, cut at the bounds; the angle of a free frame runs past them.
  /// The quantile is the normal distribution's for known sigma and Student's t else, with the
  /// degrees of freedom of the residuals, or of the samples for the sandwich. Unknowns at a bound
  /// count as free: the bound is no measurement.
  std::vector<std::optional<std::pair<double, double>>> interval95;
  /// Of that distribution: infinite for the normal one.
  double degrees_of_freedom = 1;
  /// [unknown][unknown]; none where either has no stddev.
  std::vector<std::vector<std::optional<double>>> correlation;
  /// [unknown, unknown]; 0 for what is fixed or undetermined.
  Eigen::MatrixXd covariance;
  /// Sum of squared residuals over the degrees of freedom; only under chi2.
  std::optional<double> reduced_chi2;
  /// The residuals are larger than the known sigma explains, beyond 5 standard deviations.
  bool misfit = false;
};

/// Which covariance to take, and what of it is known before the samples are looked at again.
Uncertainty uncertainty_kind(const Solution& solution, const Identifiability& identifiability,
                             const WeightedSamples& samples, const Options& options);

/// Completes what uncertainty_kind() began. `assessment` is needed for the sandwich.
void complete_uncertainty(const Solution& solution, const Identifiability& identifiability,
                          const WeightedSamples& samples, const brdf::Model& model, const Box& box,
                          std::span<const Unknown> unknowns, const Assessment& assessment,
                          Uncertainty& uncertainty);

}  // namespace gonio::fit
