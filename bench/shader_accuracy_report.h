// The tables that bench/shader_accuracy prints.
#pragma once

#include <string>
#include <vector>

#include "bench/shader_accuracy_study.h"

namespace gonio::bench {

/// For every model and language the parameters with the largest error, and where it is; a mark
/// before the lines where a figure does not hold.
std::string shader_error_table(const std::vector<ShaderErrors>& all);

/// For every material the error of the shader and what the rounding of the directions to float
/// changes, measured and at most.
std::string narrow_lobe_table(const std::vector<ShaderErrors>& all);

}  // namespace gonio::bench
