// ASAM OpenMATERIAL 3D BRDF tables (.xompt), JSON: metadata, brdf.wavelengths in metres, and
// brdf.lookupTable with rows of wavelength, incident zenith, exit zenith and exit azimuth in
// radians, and f_r in 1/sr.
//
// The exit azimuth is relative to that of the light: wi lies at azimuth 0, so that 0 is towards the
// light and pi the side of the mirror direction. The standard calls the incident ray the reference
// and leaves open which of its two sides is 0; export/openmaterial.h takes the same.
//
// Source: ASAM OpenMATERIAL 3D 1.0.0, material_brdf_schema.json.
#pragma once

#include <string>
#include <string_view>

#include "table/gridded_table.h"
#include "table/read.h"
#include "table/sample_table.h"

namespace gonio::table {

/// True for a JSON object that begins with a look-up table of OpenMATERIAL, of a BRDF or other.
bool is_openmaterial(std::string_view content);

/// A sample for each direction, in the order in which the rows first name them; a channel for each
/// wavelength, 550nm, or the one channel brdf where rows have null for it. A direction that a
/// wavelength lacks, or has null for, is a hole. A zenith of 1.570796, the largest that the
/// standard allows, is the horizon. Weights are the solid angles of wi times wo; none where the
/// exit directions form no grid. Throws FileError.
SampleTable read_openmaterial(std::string_view content, const std::string& path,
                              const ReadOptions& options);

/// f_r between the rows, per channel: linear in azimuth, then exit zenith, then incident zenith.
/// Azimuths up to pi stand for both sides. NaN beyond the angles of the file, and where a value
/// that counts is null. Throws FileError.
GriddedTable read_openmaterial_grid(std::string_view content, const std::string& path);

}  // namespace gonio::table
