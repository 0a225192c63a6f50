// The problem at given parameters, as the solver sees it.
#pragma once

#include <vector>

#include "fit/batch_model.h"
#include "fit/chunk_pass.h"
#include "fit/linear_system.h"
#include "fit/loss.h"
#include "fit/parameters.h"
#include "fit/weighted_samples.h"

namespace gonio::fit {

/// The problem at the last values asked for: the solver asks twice for an accepted step, once for
/// its cost and once for its Jacobian, and a pass over the table is dear.
class LastEvaluation {
 public:
  /// Keeps references to all of them.
  LastEvaluation(const WeightedSamples& samples, const BatchModel& model, const Box& box,
                 const ScaledLoss& loss, const PassOptions& passes);

  /// The amplitudes are solved for, whatever they are asked to be: joint_system.h.
  bool projectable() const { return projectable_; }

  /// One pass over the samples, unless the values are the last ones.
  void move_to(const ParameterValues& values);

  /// The values asked for, with the amplitudes that were solved for.
  const ParameterValues& values() const { return values_; }
  /// What the solver works on.
  const LinearSystem& system() const { return projectable_ ? projected_ : full_; }
  /// Amplitudes and shape together.
  const LinearSystem& full_system() const { return full_; }

 private:
  const WeightedSamples& samples_;
  const BatchModel& model_;
  const Box& box_;
  const ScaledLoss& loss_;
  const PassOptions& passes_;
  bool projectable_;
  bool evaluated_ = false;
  ParameterValues values_;
  LinearSystem projected_;
  LinearSystem full_;
};

}  // namespace gonio::fit
