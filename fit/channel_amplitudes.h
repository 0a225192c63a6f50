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

/// The free amplitudes that minimise |basis * coefficients - values|^2 within the box; those
/// without influence are as near to 0 as they may be. Exact where the coefficients are affine. Else
/// the better end, to rounding, of Gauss and Newton's iterations from the least amplitudes and from
/// the largest: from one side alone they may end in a minimum that is none - Ashikhmin-Shirley's Rs
/// = 1 hides what another Rd would gain - or in the lesser one of two of Oren-Nayar's.
Eigen::VectorXd solve_amplitudes(const BatchModel& model, const FreeAmplitudes& amplitudes,
                                 const Eigen::MatrixXd& basis, const Eigen::VectorXd& values);

}  // namespace gonio::fit
