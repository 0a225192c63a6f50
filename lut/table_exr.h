// Tables as OpenEXR files, which say what they hold.
//
// One part, channels R (and G) in scan lines of the texture from v = 0: FLOAT for r32f, HALF for
// r16f, UINT with the integer's code for unorm16 and unorm8. Typed attributes, all needed to read
// it back: see docs/lut.md.
#pragma once

#include <string>
#include <string_view>

#include "lut/table.h"

namespace gonio::lut {

/// The bytes of the file.
std::string exr_of(const Table& table);

/// Throws std::runtime_error that says which part or attribute is wrong, what was found and what
/// was expected; the file's name is the caller's to add.
Table table_from_exr(std::string_view bytes);

}  // namespace gonio::lut
