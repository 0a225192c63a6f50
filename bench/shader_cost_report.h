// What bench/shader_cost prints.
#pragma once

#include <string>
#include <vector>

#include "bench/shader_cost_study.h"

namespace gonio::bench {

/// What the columns are, and what is compared with what.
std::string shader_cost_preface();

/// The numbers of every shader on one chip, and then what they say of the authors' claims.
std::string shader_cost_table(const std::string& chip, const ChipCosts& costs);

/// The same as a JSON object.
std::string shader_cost_json(const std::string& chip, const ChipCosts& costs);

}  // namespace gonio::bench
