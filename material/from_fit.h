// What a fit found, as a material.
#pragma once

#include <string>

#include "fit/fit.h"
#include "material/material.h"
#include "table/sample_table.h"

namespace gonio::material {

/// The fitted material with its uncertainty and provenance; `command` is the command line that made
/// it. Its name is the table's, or else the file's without folder and ending.
Material from_fit(const fit::FitResult& result, const table::SampleTable& table,
                  const std::string& command);

}  // namespace gonio::material
