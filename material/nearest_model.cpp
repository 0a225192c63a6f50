#include "material/nearest_model.h"

#include "fit/fit.h"
#include "material/comparison.h"
#include "material/from_fit.h"

namespace gonio::material {

NearestMaterial nearest_material(const table::SampleTable& samples, const brdf::Model& model,
                                 fit::Metric metric, std::span<const fit::ParameterSetting> fixed,
                                 std::span<const fit::ParameterSetting> start) {
  fit::Options options{.metric = metric, .max_theta_deg = largest_compared_theta_deg};
  options.fixed.assign(fixed.begin(), fixed.end());
  options.start.assign(start.begin(), start.end());
  const fit::FitResult result = fit::fit(model, samples, options);
  Material material = from_fit(result, samples, "");
  material.fit.reset();
  material.provenance.reset();
  for (ParameterValue& parameter : material.parameters) {
    parameter.stddev.clear();
    parameter.interval95.clear();
  }
  return {std::move(material), result.metric_error};
}

}  // namespace gonio::material
