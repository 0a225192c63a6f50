// The material of a given model that is nearest to a reflectance: fitted to its values on the
// directions of comparison.h as a measured table would be.
#pragma once

#include <span>

#include "brdf/model.h"
#include "fit/options.h"
#include "material/material.h"
#include "table/sample_table.h"

namespace gonio::material {

/// A material fitted to samples, and what the fit minimised: the root mean square of the metric's
/// residuals, weighted by solid angle.
struct NearestMaterial {
  Material material;
  double metric_error;
};

/// Fits `model` to samples of a reflectance (comparison.h), viewers up to 80 deg, weighted by solid
/// angle. `fixed` and `start` as in fit::Options; with every parameter fixed nothing moves. The
/// material has no fit summary, since nothing was measured, and no name. Throws
/// std::invalid_argument for settings that do not suit the model.
NearestMaterial nearest_material(const table::SampleTable& samples, const brdf::Model& model,
                                 fit::Metric metric,
                                 std::span<const fit::ParameterSetting> fixed = {},
                                 std::span<const fit::ParameterSetting> start = {});

}  // namespace gonio::material
