// ASAM OpenMATERIAL 3D: a material file (.xomp) and the table of its reflectance (_brdf.xompt),
// both JSON, for simulated sensors.
//
// The format knows no models: the table is sampled from the material, and what is lost is what its
// linear interpolation loses, and the tangent of an anisotropic material, over whose azimuths the
// table is the mean. The material itself, at full precision, stands in the material file among its
// custom properties.
//
// Source: ASAM OpenMATERIAL 3D 1.0.0, sections 8.2 and 8.3 and the checker rules of annex A. Rows
// are wavelength in m, incident zenith, exit zenith and exit azimuth in rad, f_r in 1/sr,
// ascending. Where the standard leaves open on which side azimuth 0 is, here it is towards the
// light: the mirror direction is at pi. Azimuths cover the whole circle.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "export/exported.h"
#include "material/material.h"

namespace gonio::exports {

/// What the format demands and a material does not know; NOASSERTION is what SPDX says for unknown.
struct OpenMaterialOptions {
  std::string copyright = "NOASSERTION";
  std::string license = "NOASSERTION";  // an SPDX identifier, a URL or a file
  std::string author = "unknown";
  /// How large the table may be, at least 2500; less for very many wavelengths.
  std::size_t most_rows_per_wavelength = 40000;
};

/// What the name of the table's file ends in, after the stem; the standard asks for it.
inline constexpr std::string_view openmaterial_table_ending = "_brdf.xompt";

/// The material file, and second the table, which has to be written beside it as `stem` with
/// openmaterial_table_ending: the first names it so. The same material gives the same texts.
/// Throws table::FileError for several channels that are neither wavelengths ("465nm") nor R, G and
/// B, for two of the same wavelength, for one outside 1 nm to 17.16 mm, and for a highlight that is
/// too narrow for a table.
Exported to_openmaterial(const material::Material& material, const std::string& stem,
                         const OpenMaterialOptions& options = {});

}  // namespace gonio::exports
