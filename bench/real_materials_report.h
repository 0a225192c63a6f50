// The results of real_materials as CSV and as Markdown.
#pragma once

#include <string>
#include <vector>

#include "bench/real_materials_study.h"

namespace gonio::bench {

/// A row per material, model and metric, with a header: source, material, samples, used, model,
/// rank, converged, metric, error.
std::string real_materials_csv(const std::vector<RealResult>& results);

/// Tables per source: how each model did over its materials, and the error of every model on every
/// material under `metric`, the metric of the fits.
std::string real_materials_markdown(const std::vector<RealResult>& results,
                                    const std::string& metric);

}  // namespace gonio::bench
