// How a look-up table is read, in words and formulas, for the author of a shader.
#pragma once

#include <string>

#include "lut/layout.h"

namespace gonio::lut {

/// "the lobes of alpha 0.05", "s and m at t = 0", ..
std::string served_text(const Layout& layout);

/// Several lines: w, the texture coordinate, what the texel stands for and how the lobe follows.
std::string sampling_text(const Layout& layout);

}  // namespace gonio::lut
