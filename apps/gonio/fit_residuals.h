// The table that gonio fit --residuals writes: the samples, and what the model leaves of them.
#pragma once

#include <string>

#include "material/material.h"
#include "table/sample_table.h"

namespace gonio::app {

/// Throws std::invalid_argument if the table has a channel that is named like a column which
/// write_residuals() adds.
void check_residual_columns(const table::SampleTable& table);

/// Writes the table with a column of the model's values and one of the residuals per channel, in
/// 1/sr. Throws table::FileError.
void write_residuals(const std::string& path, const table::SampleTable& table,
                     const material::Material& material);

}  // namespace gonio::app
