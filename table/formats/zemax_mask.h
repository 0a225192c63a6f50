// Which samples of a Zemax tabular BSDF were measured.
#pragma once

#include <vector>

#include "table/formats/zemax_text.h"
#include "table/sample_table.h"

namespace gonio::table {

/// A reason per sample, in the order of the file, and in `text` a quiet NaN for each value of a
/// masked sample:
///   horizon   wi or wo lies within 1e-6 deg of the horizon or below it
///   padding   zero in all channels where nothing was measured: for one rotation and incidence, at
///             least 3 samples beyond the polar angle of the last one that is not zero; or two or
///             more zeros that end the row of an azimuth, those below the horizon included
/// A zero between values is data.
std::vector<MaskReason> mask_zemax(ZemaxText& text);

}  // namespace gonio::table
