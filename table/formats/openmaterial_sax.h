// The numbers of an OpenMATERIAL 3D table, straight from the JSON text into arrays: the document as
// a tree of values would take more than ten times the room of the text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gonio::table {

/// A row of brdf.lookupTable. NaN stands for null: an axis that is not resolved, or no value.
struct OpenMaterialRow {
  double wavelength;  // m
  double theta_i;     // radians
  double theta_o;     // radians
  double phi;         // radians, of the exit direction from the incident one
  double f_r;         // 1/sr
};

struct OpenMaterialText {
  std::string name;                 // metadata.name on one line, or empty
  std::vector<double> wavelengths;  // m, as brdf.wavelengths lists them
  std::vector<OpenMaterialRow> rows;
};

/// Both zeniths of each row are known and lie in 0 .. pi/2 (+ 1e-6 deg), its azimuth is known and
/// lies in 0 .. 2 pi (+ 1e-6): where it does not matter, null is read as 0. Wavelengths lie in
/// 1 nm .. 17.16 mm. There is one row at least. Throws FileError, which names the row by its index
/// from 0, "/brdf/lookupTable/17".
OpenMaterialText parse_openmaterial(std::string_view content, const std::string& path);

}  // namespace gonio::table
