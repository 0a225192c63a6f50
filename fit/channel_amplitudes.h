// The amplitudes of one channel by linear least squares, where the coefficients of the basis
// functions are linear in them; and by a few such problems where they are not.
#pragma once

#include <Eigen/Core>

#include "fit/batch_model.h"
#include "fit/parameters.h"

namespace gonio::fit {

/// The amplitudes of a channel that are free to be chosen, and the box that they are in.
struct FreeAmplitudes {
  FreeAmplitudes(const Box& box, Eigen::Index channel);

  /// All amplitudes of the channel.
  Eigen::VectorXd all(const Eigen::VectorXd& free) const { return space.offset + space.map * free; }

  const AmplitudeSpace& space;
  Eigen::VectorXd lower, upper;
};

/// The coefficients near given amplitudes, to first order in the free ones:
/// offset + slope * free.
struct LinearCoefficients {
  LinearCoefficients(const BatchModel& model, const FreeAmplitudes& amplitudes,
                     const Eigen::VectorXd& free);

  Eigen::VectorXd offset;
  Eigen::MatrixXd slope;  // [basis, free]
};

/// The free amplitudes that minimise |basis * coefficients - values|^2 within the box. Exact where
/// the coefficients are affine; else Gauss and Newton's iterations, down to rounding, that begin
/// with the amplitudes nearest to 0.
Eigen::VectorXd solve_amplitudes(const BatchModel& model, const FreeAmplitudes& amplitudes,
                                 const Eigen::MatrixXd& basis, const Eigen::VectorXd& values);

}  // namespace gonio::fit
