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
#include <string_view>
#include <vector>

#include "table/read.h"
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

/// True if the content looks like either file of a pair, told by its first rows of numbers, which
/// blanks separate: directions, rows of 5 numbered from 1 on, or measurements, rows of one length,
/// each the whole number of a material and at least 50 others.
bool is_curet(std::string_view content);

/// The material ReadOptions::material of the pair that `content`, either file of it, belongs to; it
/// may be left out where there is one material only. The other file is looked for beside `path`:
/// first under its published name, table.txt or abrdf.dat, then among the first 100 others that end
/// in .txt or .dat; it is the first of the other kind that has as many directions. A note names it.
/// Throws FileError.
SampleTable read_curet_file(std::string_view content, const std::string& path,
                            const ReadOptions& options);

}  // namespace gonio::table
