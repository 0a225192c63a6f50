// Start values from the data: a scan of the shape over a subset of the table.
#pragma once

#include <span>
#include <vector>

#include "fit/batch_model.h"
#include "fit/options.h"
#include "fit/parameters.h"
#include "table/sample_table.h"

namespace gonio::fit {

/// About `count` of the used samples of `table`, weighted so that sums over the subset stand for
/// sums over the table: of each run of consecutive used samples the brightest (narrow lobes live in
/// few samples) and one other that speaks for the rest. The whole if it is no larger.
table::SampleTable representative_subset(const table::SampleTable& table,
                                         const table::SampleFilter& filter,
                                         std::size_t used_samples, std::size_t count);

/// Where a solution over the whole table starts.
struct Start {
  std::vector<double> shape;
  int iterations;  // of the solver on the subset, to get there
};

/// Starts, best first: the local minima, solved on `subset`, of a scan over the
/// shape's search range (with the amplitudes projected out), as far as their cost comes near the
/// best one's. Parameters with a start value or a fixed one keep it in the scan.
std::vector<Start> search_starts(const table::SampleTable& subset, const BatchModel& model,
                                 const Box& box, const Options& options);

}  // namespace gonio::fit
