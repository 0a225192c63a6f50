// The shader function of one bound model, in HLSL, without the files that it needs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/bound_model.h"
#include "shader/table_source.h"

namespace gonio::shader {

struct FunctionText {
  std::string signature;
  std::string text;
  std::vector<std::string_view> files;  // of shader/hlsl, without their extension
};

/// The function of that name (compose.h). With a table its terms are read from it that it serves.
FunctionText function_text(const brdf::BoundModel& model, const std::string& name,
                           const std::optional<TableText>& table);

}  // namespace gonio::shader
