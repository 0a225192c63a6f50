// A material as a shader function: HLSL or GLSL with the parameters in it (shader/compose.h). Any
// model and any number of channels; nothing is lost but what float arithmetic rounds. Three
// channels that are red, green and blue (rgb.h) come in this order.
#pragma once

#include "export/exported.h"
#include "material/material.h"

namespace gonio::exports {

Exported to_hlsl(const material::Material& material);
Exported to_glsl(const material::Material& material);

}  // namespace gonio::exports
