// Zemax tabular BSDF: f_r about the specular direction, text (zemax_text.h describes it).
//
// With wi the direction to the light, s its mirror direction, t the unit vector across s that
// points from s to the normal, b = s x t, a scattered direction is
//   wo = cos(radial) s + sin(radial) (cos(azimuth) t + sin(azimuth) b).
// The values are f_r in 1/sr without a cosine, which reciprocity in the plane of incidence shows.
#pragma once

#include <string>
#include <string_view>

#include "table/gridded_table.h"
#include "table/read.h"
#include "table/sample_table.h"

namespace gonio::table {

/// True if the content starts, behind comments, with keywords of this format.
bool is_zemax(std::string_view content);

/// All samples in the order of the file. A rotation of the sample by SampleRotation, from x to y,
/// turns both directions by as much the other way. Samples below the horizon are masked, and so is
/// as `padding` what instruments' software fills with zeros beyond what was measured. Weights are
/// solid angles: of wo about the specular direction times of wi. Throws FileError.
SampleTable read_zemax(std::string_view content, const std::string& path,
                       const ReadOptions& options);

/// f_r between the samples: linear in azimuth, radial angle, incidence and, where there are
/// several, rotation; azimuth and radial angle are those about the specular direction of the wi
/// that is asked for. NaN outside the lists of angles and where a sample that counts is a hole.
/// Throws FileError.
GriddedTable read_zemax_grid(std::string_view content, const std::string& path);

}  // namespace gonio::table
