// Files of the RGL (EPFL) database: a measured isotropic material in the adaptive parameterization
// of Dupuy & Jakob 2018, three colours or a spectrum.
//
// With wm the half vector's direction, u = sqrt(2 theta / pi) and v = (phi + pi) / (2 pi):
//   f_r cos(theta_o) = rgb(s; wi) ndf(u_wm) / (4 sigma(u_wi))
// where s is the point that the warp of the density vndf(wi) takes to u_wm, and the azimuth of wm
// is that from wi. All look-ups are bilinear, between incident polar angles linear. A channel that
// comes out negative lies outside of its gamut and counts as 0.
#pragma once

#include <string>
#include <string_view>

#include "table/gridded_table.h"
#include "table/read.h"

namespace gonio::table {

bool is_rgl(std::string_view content);

/// A sample for each node of the file's own grid of rgb or spectra, per incident polar angle, with
/// wi at azimuth 0; its weight is the solid angle of wo times that of wi. Channels are R, G, B or
/// wavelengths such as 550nm. Throws FileError, also for an anisotropic material.
SampleTable read_rgl(std::string_view content, const std::string& path, const ReadOptions& options);

/// The formula above. Incident polar angles beyond those of the file take the nearest one's data.
/// Throws FileError as read_rgl() does.
GriddedTable read_rgl_grid(std::string_view content, const std::string& path);

}  // namespace gonio::table
