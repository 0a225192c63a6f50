// A material as one of Radiance's (radiance_lobe.h).
#pragma once

#include "export/exported.h"
#include "material/material.h"

namespace gonio::exports {

/// A scene fragment that defines one modifier of the material's name: of plastic and metal, or for
/// a model with a tangent of plastic2 and metal2, the one with the smaller loss. Throws as
/// rgb_material() does.
Exported to_radiance(const material::Material& material);

}  // namespace gonio::exports
