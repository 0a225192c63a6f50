// Tables as OpenEXR files, which say what they hold.
//
// One part, channels R (and G) in scan lines of the texture from v = 0: HALF for r16f, else
// FLOAT; of unorm16 and unorm8 the 0..1 that the integers stand for, which a program that makes the
// texture rounds to the integers again without a loss. Typed attributes, all needed to read it
// back: see docs/lut.md.
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
