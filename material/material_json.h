// The material JSON file, as schema/material.schema.json describes it.
//
// Amplitudes are arrays with one entry per channel, shapes are numbers. An undetermined standard
// deviation or interval is null. What is read is what was written, to the last bit.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "material/material.h"

namespace gonio::material {

/// Reads a material file of any version up to 1, hand-written or written by write_material().
/// `model` may be a bare name; with one channel an amplitude may be a plain number. Further
/// members at the top level, such as the timing of `gonio fit --json`, are passed over. Throws
/// table::FileError with the field, what was found and what was expected.
Material read_material(const std::string& path);

/// The same for a text; `path` is for messages.
Material parse_material(std::string_view json, const std::string& path);

/// The material as JSON, its members in a fixed order.
nlohmann::ordered_json to_json(const Material& material);

/// Writes the material file, whole or not at all. Throws table::FileError if the file cannot be
/// written, or if it could not be read back: an unknown model, unsuitable values, a number that
/// is not finite.
void write_material(const Material& material, const std::string& path);

}  // namespace gonio::material
