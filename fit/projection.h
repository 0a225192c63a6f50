// Variable projection (Golub & Pereyra 1973): for a given shape the amplitudes are solved by
// bounded linear least squares, and what remains is a problem in the shape alone, with Kaufman's
// (1975) Jacobian. Everything happens in the compressed problem of a few rows per channel.
#pragma once

#include <Eigen/Core>

#include "fit/batch_model.h"
#include "fit/compression.h"
#include "fit/linear_system.h"
#include "fit/parameters.h"

namespace gonio::fit {

struct Projected {
  Eigen::MatrixXd amplitudes;  // [amplitude, channel], within their bounds
  /// Without amplitude_jacobian. shape_jacobian is Kaufman's: its J'r is the exact gradient of the
  /// projected cost. Empty without derivatives.
  LinearSystem system;
};

/// Projects the amplitudes out, within the box. `compressed` must hold the derivative columns if
/// `with_jacobian`.
Projected project(const Compressed& compressed, const BatchModel& model, const Box& box,
                  bool with_jacobian);

/// The system of amplitudes and shape together, at the given amplitudes. `compressed` must hold the
/// derivative columns.
LinearSystem linear_system_of(const Compressed& compressed, const BatchModel& model,
                              const Eigen::MatrixXd& amplitudes);

}  // namespace gonio::fit
