#include "fit/channel_amplitudes.h"

#include "fit/bounded_least_squares.h"

namespace gonio::fit {
namespace {

/// Gauss and Newton's steps are quadratic where the coefficients reach the data, as
/// Ashikhmin-Shirley's do, and shrink by a small factor for Oren-Nayar's rho^2.
constexpr int most_iterations = 60;
constexpr int most_halvings = 30;

double square_at(const BatchModel& model, const FreeAmplitudes& amplitudes,
                 const Eigen::MatrixXd& basis, const Eigen::VectorXd& values,
                 const Eigen::VectorXd& free) {
  return (basis * model.coefficients(amplitudes.all(free)) - values).squaredNorm();
}

Eigen::VectorXd step_from(const BatchModel& model, const FreeAmplitudes& amplitudes,
                          const Eigen::MatrixXd& basis, const Eigen::VectorXd& values,
                          const Eigen::VectorXd& free) {
  const LinearCoefficients near(model, amplitudes, free);
  return bounded_least_squares(basis * near.slope, values - basis * near.offset, amplitudes.lower,
                               amplitudes.upper);
}

}  // namespace

FreeAmplitudes::FreeAmplitudes(const Box& box, Eigen::Index channel)
    : space(box.amplitudes),
      lower(box.amplitude_lower(space.free, channel)),
      upper(box.amplitude_upper(space.free, channel)) {}

LinearCoefficients::LinearCoefficients(const BatchModel& model, const FreeAmplitudes& amplitudes,
                                       const Eigen::VectorXd& free) {
  const Eigen::VectorXd all = amplitudes.all(free);
  slope = model.coefficient_jacobian(all) * amplitudes.space.map;
  offset = model.coefficients(all) - slope * free;
}

Eigen::VectorXd solve_amplitudes(const BatchModel& model, const FreeAmplitudes& amplitudes,
                                 const Eigen::MatrixXd& basis, const Eigen::VectorXd& values) {
  Eigen::VectorXd free = amplitudes.lower.cwiseMax(0).cwiseMin(amplitudes.upper);
  if (model.coefficients_kind() != brdf::Coefficients::nonlinear) {
    return step_from(model, amplitudes, basis, values, free);
  }
  double square = square_at(model, amplitudes, basis, values, free);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Eigen::VectorXd next = step_from(model, amplitudes, basis, values, free);
    double next_square = square_at(model, amplitudes, basis, values, next);
    for (int halving = 0; halving < most_halvings && next_square > square; ++halving) {
      next = (next + free) / 2;
      next_square = square_at(model, amplitudes, basis, values, next);
    }
    if (!(next_square <= square)) break;
    const double change = (next - free).lpNorm<Eigen::Infinity>();
    free = std::move(next);
    square = next_square;
    if (change <= 1e-15 * free.lpNorm<Eigen::Infinity>()) break;
  }
  return free;
}

}  // namespace gonio::fit
