// The table that gonio fit --residuals writes: the samples, and what the model leaves of them.
#pragma once

#include <string>

#include "fit/fit.h"
#include "material/material.h"
#include "table/sample_table.h"

namespace gonio::app {

/// Throws std::invalid_argument if the table has a channel that is named like a column which
/// write_residuals() adds.
void check_residual_columns(const table::SampleTable& table, const fit::Options& options);

/// Writes the table with a column of the model's values and one of the residuals per channel, in
/// 1/sr; with a robust loss also one that is 1 for an outlier of the fit and 0 for another value
/// that it used. `options` are those that gave `result`. Throws table::FileError.
void write_residuals(const std::string& path, const table::SampleTable& table,
                     const material::Material& material, const fit::FitResult& result,
                     const fit::Options& options);

}  // namespace gonio::app
