#include "fit/evaluation.h"

#include <utility>

#include "fit/compression.h"
#include "fit/joint_system.h"
#include "fit/projection.h"

namespace gonio::fit {

LastEvaluation::LastEvaluation(const WeightedSamples& samples, const BatchModel& model,
                               const Box& box, const ScaledLoss& loss, const PassOptions& passes)
    : samples_(samples),
      model_(model),
      box_(box),
      loss_(loss),
      passes_(passes),
      projectable_(is_projectable(samples.metric(), loss.loss)) {}

void LastEvaluation::move_to(const ParameterValues& values) {
  if (evaluated_ && values_.shape == values.shape &&
      (projectable_ || values_.amplitudes == values.amplitudes)) {
    return;
  }
  evaluated_ = true;
  values_ = values;
  if (!projectable_) {
    full_ = joint_system_of(samples_, model_, values_, loss_, passes_);
    return;
  }
  const Compressed compressed = compress(samples_, model_, values_.shape, true, passes_);
  Projected projected = project(compressed, model_, box_, true);
  values_.amplitudes = std::move(projected.amplitudes);
  projected_ = std::move(projected.system);
  full_ = linear_system_of(compressed, model_, values_.amplitudes);
}

}  // namespace gonio::fit
