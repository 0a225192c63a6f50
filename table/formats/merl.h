// MERL `.binary`: an isotropic BRDF in red, green and blue on a grid of directions
// (merl_grid.h).
//
//   int32    sizes of theta_h, theta_d, phi_d: 90, 90, 180; little endian
//   float64  red, green, blue: a value per bin each, phi_d fastest, theta_h slowest
//
// f_r in 1/sr is the value times 1/1500, 1.15/1500, 1.66/1500; a negative value is no measurement.
//
// Source: Matusik, Pfister, Brand & McMillan, A Data-Driven Reflectance Model, ACM Transactions on
// Graphics 22(3), 2003, and the description of its database.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "table/gridded_table.h"
#include "table/read.h"
#include "table/sample_table.h"

namespace gonio::table {

/// f_r in 1/sr of a value of 1 in the file, per channel.
inline constexpr std::array<double, 3> merl_scales{1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
inline constexpr std::array<const char*, 3> merl_channels{"R", "G", "B"};

/// True for the sizes of MERL's own grid, and for others if about as many bytes follow as they
/// need.
bool is_merl(std::string_view content);

/// Every bin in the order of the file, at its node, with h in the plane of x and z. Channels R, G,
/// B; the weight is merl_weight(). Bins with a node at the horizon or below it are masked as
/// horizon; there, too, a value is kept. Throws FileError.
SampleTable read_merl(std::string_view content, const std::string& path,
                      const ReadOptions& options);

/// f_r is that of the bin which the directions fall into, as the database's own reader has it:
/// there is nothing between bins. Throws FileError.
GriddedTable read_merl_grid(std::string_view content, const std::string& path);

}  // namespace gonio::table
