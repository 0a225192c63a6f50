// The project's compact table: samples as the pixels of an OpenEXR image, with typed attributes
// that say what they are. See docs/formats.md.
#pragma once

#include <string>
#include <string_view>

#include "table/read.h"
#include "table/sample_table.h"

namespace gonio::table {

// The attributes, and what each holds.
namespace exr_attribute {
inline constexpr const char* version = "gonioSampledBrdf";       // int: 1
inline constexpr const char* samples = "gonioSamples";           // int: pixels behind are padding
inline constexpr const char* quantity = "gonioQuantity";         // string: brdf
inline constexpr const char* units = "gonioUnits";               // stringvector: 1/sr, deg
inline constexpr const char* axes = "gonioAxes";                 // stringvector: pixel channels
inline constexpr const char* channels = "gonioChannels";         // stringvector: of the table
inline constexpr const char* pixel_channels = "gonioPixels";     // stringvector: where each is
inline constexpr const char* wavelengths = "gonioWavelengths";   // floatvector: nm, if all have one
inline constexpr const char* mask_reasons = "gonioMaskReasons";  // stringvector: by code
inline constexpr const char* isotropy = "gonioTakesIsotropy";    // int, 1: one azimuth for all
inline constexpr const char* solid_angle = "gonioWeightIsSolidAngle";  // int, 1
inline constexpr const char* name = "gonioName";                       // string
inline constexpr const char* source = "gonioSource";  // stringvector: file, format, ..
inline constexpr const char* notes = "gonioNotes";    // stringvector
}  // namespace exr_attribute
inline constexpr int exr_table_version = 1;

/// True for any OpenEXR file.
bool is_exr_table(std::string_view content);

/// Reads a table that write_exr_table() wrote. Throws FileError, also for an image that is no
/// table.
SampleTable read_exr_table(std::string_view content, const std::string& path,
                           const ReadOptions& options);

}  // namespace gonio::table
