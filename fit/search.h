// Start values from the data: a scan of the shape over a subset of the table.
#pragma once

#include <span>
#include <vector>

#include "fit/batch_model.h"
#include "fit/options.h"
#include "fit/parameters.h"
#include "table/sample_table.h"

namespace gonio::fit {

/// Where a solution over the whole table starts.
struct Start {
  ParameterValues values;
  int iterations;  // of the solver on the subset, to get there
};

/// Starts, best first. The shape's search range is scanned on a thin part of `subset`, with the
/// amplitudes solved for at each point; the minima are solved, first there, then on `subset`, as
/// far as their cost comes near the best one's. Fixed parameters keep their value; options.start
/// adds scans that keep it. `floors` as in WeightedSamples.
std::vector<Start> search_starts(const table::SampleTable& subset, const BatchModel& model,
                                 const Box& box, const Options& options,
                                 std::span<const double> floors);

}  // namespace gonio::fit
