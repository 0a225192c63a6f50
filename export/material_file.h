// The material file of gonio itself (material/material_json.h) as a target among others.
#pragma once

#include "export/exported.h"
#include "material/material.h"

namespace gonio::exports {

/// The material as it is read, its fit and provenance included; nothing is lost.
Exported to_material_file(const material::Material& material);

}  // namespace gonio::exports
