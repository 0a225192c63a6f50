// All the outliers of a fit, where FitResult::outliers lists the worst.
#pragma once

#include <vector>

#include "fit/fit.h"

namespace gonio::fit {

/// Every value beyond result.outlier_threshold, the worst first; none without a robust loss.
/// `table` and `options` are those that gave `result`.
std::vector<Outlier> all_outliers(const FitResult& result, const table::SampleTable& table,
                                  const Options& options);

}  // namespace gonio::fit
