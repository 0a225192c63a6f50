// What a pixel shader costs on GPU chips (shader/instruction_counts.h), for every model and every
// path: the published listings and their rivals, the function composed for the model, and that with
// each of the model's look-up tables.
#pragma once

#include <string>
#include <vector>

#include "shader/instruction_counts.h"

namespace gonio::bench {

struct CostedShader {
  std::string subject;     // what is computed: a model, or a listing's
  std::string path;        // and how
  std::string parameters;  // "uniforms", "literals"; empty where there are none
  int published = 0;       // Direct3D 10 instructions; 0 where there is no figure
  std::string hlsl;
};

/// The listings first, then the models of brdf::model_names().
std::vector<CostedShader> costed_shaders();

struct ShaderCost {
  CostedShader shader;
  shader::InstructionCounts counts;
};

struct ChipCosts {
  std::string device;
  std::vector<ShaderCost> costs;
};

/// `chip`: as shader::ChipCompiler. Throws shader::NoChipCompiler.
ChipCosts shader_costs(const std::string& chip);

}  // namespace gonio::bench
