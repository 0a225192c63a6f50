// CUReT's BRDFs: a pair of text files, one with the directions that all its materials were measured
// in, one with a row of measurements for each material.
//
//   directions    (table.txt)  index from 1, theta_v, phi_v, theta_i, phi_i: radians, v = viewer
//   measurements  (abrdf.dat)  number of the material, then its BRDF in each direction: 1/sr, the
//                              mean of red, green and blue, to three decimals
//
// Source: Dana, van Ginneken, Nayar & Koenderink, Reflectance and Texture of Real-World Surfaces,
// ACM Transactions on Graphics 18(1), 1999.
#pragma once

#include <string>
#include <vector>

#include "table/sample_table.h"

namespace gonio::table {

/// The paths of a pair.
struct CuretFiles {
  std::string measurements;
  std::string directions;
};

/// All the materials of a pair, in the order of the file, each with one channel "mean". A reading
/// of 0 or less is a hole: a rounded or failed measurement, of which a note says how many there
/// are. Throws FileError.
std::vector<SampleTable> read_curet(const CuretFiles& files);

/// One material by its number. Throws FileError, also where there is none of this number.
SampleTable read_curet(const CuretFiles& files, int material);

}  // namespace gonio::table
