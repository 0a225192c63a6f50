// The member "fit" of the material JSON file: how the parameters were found.
#pragma once

#include <nlohmann/json.hpp>

#include "material/material.h"
#include "table/json_file.h"

namespace gonio::material {

/// Reads the object at `field`. Every member may be absent; others than the known ones are passed
/// over. Throws table::FileError with the field, what was found and what was expected.
FitSummary read_fit_summary(const table::JsonField& field);

/// The object, its members in a fixed order; what the fit has not is left out.
nlohmann::ordered_json json_of(const FitSummary& fit);

}  // namespace gonio::material
