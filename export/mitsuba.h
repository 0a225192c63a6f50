// A material as one of Mitsuba 3's (mitsuba_lobe.h).
#pragma once

#include "export/exported.h"
#include "material/material.h"

namespace gonio::exports {

/// A scene file with one bsdf under the material's name, to be included and referred to: of a blend
/// of diffuse and roughconductor (Beckmann's or GGX facets) and of principled the one with the
/// smallest loss. Mitsuba 3 has no Ward plugin; where Mitsuba 0.6 had one that holds the model
/// exactly, its form stands in a comment. Throws as rgb_material() does.
Exported to_mitsuba(const material::Material& material);

}  // namespace gonio::exports
