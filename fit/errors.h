// The error of given parameters under every metric, whichever was minimised.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "fit/batch_model.h"
#include "fit/chunk_pass.h"
#include "fit/parameters.h"
#include "table/sample_table.h"

namespace gonio::fit {

/// Weighted root mean square over all used samples and channels of
///   l2         f - model                                     in 1/sr
///   cosine-l2  (f - model) cos_i                             in 1/sr
///   log        difference of ln(1 + max(0, f cos_i))         (Loew et al. 2012)
///   cube-root  difference of cbrt(max(0, f cos_i))
///   relative   (f - model) / max(|f|, 1 % of the channel's median |f| that is not 0)
/// in this order. The weights are the table's own, 1 where it carries none.
using ErrorList = std::vector<std::pair<std::string_view, double>>;

/// One pass over the samples, besides the ones for the medians.
ErrorList errors_of(const table::SampleTable& table, double max_theta_deg, const BatchModel& model,
                    const ParameterValues& values, const PassOptions& passes);

}  // namespace gonio::fit
