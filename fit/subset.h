// A part of a table that stands for the whole.
#pragma once

#include <cstddef>

#include "table/sample_table.h"

namespace gonio::fit {

/// About `count` of the `used_samples` that pass the filter, weighted so that sums over the subset
/// stand for sums over the table: of each run of consecutive used samples the brightest (narrow
/// lobes live in few samples) and one other that speaks for the rest. All of them if they are no
/// more than `count`. The same for any number of threads.
table::SampleTable representative_subset(const table::SampleTable& table,
                                         const table::SampleFilter& filter,
                                         std::size_t used_samples, std::size_t count, int threads);

}  // namespace gonio::fit
