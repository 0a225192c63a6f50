// A material as a shader function: HLSL or GLSL with the parameters in it (shader/compose.h). Any
// model and any number of channels; nothing is lost but what float arithmetic rounds, and with a
// look-up table what that loses. Three channels that are red, green and blue (rgb.h) come in this
// order.
#pragma once

#include "export/exported.h"
#include "export/shader_table.h"
#include "material/material.h"

namespace gonio::exports {

Exported to_hlsl(const material::Material& material);
Exported to_glsl(const material::Material& material);

/// The same with the terms that the table serves read from it. Throws std::invalid_argument for a
/// table that serves no term of the material or other parameters.
Exported to_hlsl_with_table(const material::Material& material, const ShaderTable& table);
Exported to_glsl_with_table(const material::Material& material, const ShaderTable& table);

}  // namespace gonio::exports
