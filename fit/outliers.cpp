#include "fit/outliers.h"

#include <limits>
#include <utility>

#include "fit/weighted_samples.h"

namespace gonio::fit {

std::vector<Outlier> all_outliers(const FitResult& result, const table::SampleTable& table,
                                  const Options& options) {
  if (result.loss == Loss::none) return {};
  const table::SampleFilter filter(table, options.max_theta_deg, options.incidence);
  const std::vector<double> floors = relative_floors(table, filter, options.threads);
  const BatchModel batch(result.model);
  const WeightedSamples samples(table, batch, options, survey_of(table, filter, options.threads),
                                floors, &result.values);
  Assessment assessment = assess(samples, batch, result.values, result.unknowns, floors,
                                 {.loss = {result.loss, result.loss_scale},
                                  .outlier_threshold = result.outlier_threshold,
                                  .most_listed = std::numeric_limits<std::size_t>::max()},
                                 {.threads = options.threads, .on_pass = {}});
  return std::move(assessment.outliers);
}

}  // namespace gonio::fit
