// A material as one of glTF 2.0's (gltf_lobe.h).
#pragma once

#include "export/exported.h"
#include "material/material.h"

namespace gonio::exports {

/// A glTF asset with one material: metallic-roughness with KHR_materials_ior and
/// KHR_materials_specular, and for a model with a tangent KHR_materials_anisotropy. Its `extras`
/// hold the model, its parameters and the loss. Throws as rgb_material() does.
Exported to_gltf(const material::Material& material);

}  // namespace gonio::exports
