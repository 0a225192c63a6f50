// LBNL's BSDF XML, as Radiance and window programs read it, in a Klems basis: the hemisphere is cut
// into patches, and a matrix holds a BRDF in 1/sr for each pair of an incident and an exit patch.
//
// An AngleBasis lists rings: a polar angle with its bounds, and how many patches share the ring,
// the k-th of them centred at azimuth 360 k / nPhis. An incident patch is named by the direction in
// which the light travels, so that equal patches are each other's mirror direction. The blocks of
// direction "Reflection Front" are read, one for each Wavelength; what the file calls the data
// (BTDF, BRDF) is not asked. Source: LBNL Window 7 / Radiance "genBSDF" documentation of the
// matrix form; Klems 1994 for the basis.
#pragma once

#include <string>
#include <string_view>

#include "table/gridded_table.h"
#include "table/read.h"

namespace gonio::table {

/// True for XML whose root is a WindowElement.
bool is_klems(std::string_view content);

/// A sample for each pair of patches, at their centres; a channel for each Wavelength, named after
/// it (Visible, Solar). The weight is the product of both patches' projected solid angles. Throws
/// FileError.
SampleTable read_klems(std::string_view content, const std::string& path,
                       const ReadOptions& options);

/// The value of the patches that the directions fall into. Throws FileError.
GriddedTable read_klems_grid(std::string_view content, const std::string& path);

}  // namespace gonio::table
