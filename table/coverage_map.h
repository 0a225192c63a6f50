// Where on the exitant hemisphere a table has samples, and why the others are masked: a picture in
// cells of polar angle and azimuth.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "table/describe.h"
#include "table/sample_table.h"

namespace gonio::table {

/// A cell of the hemisphere: empty if no sample is there, else `none` if one of them is in use,
/// else the reason that most are masked for.
using CoverageCell = std::optional<MaskReason>;

/// The exitant directions of the light at one polar angle, or in one bin of it.
struct CoverageMap {
  static constexpr std::size_t polar_cells = 9;     // of 10 deg, from the normal
  static constexpr std::size_t azimuth_cells = 13;  // of 15 deg, centred on 0, 15, .. 180
  double theta_i_deg;
  /// By polar angle and azimuth from the light, either way round: 0 towards it, 180 deg the mirror
  /// direction. A viewer within 1e-6 deg of the normal is in every azimuth.
  std::array<std::array<CoverageCell, azimuth_cells>, polar_cells> cells;
};

/// Maps of at most `most` of the description's incidences, spread over all. Samples below the
/// horizon are left out.
std::vector<CoverageMap> coverage_maps(const SampleTable& table, const Description& description,
                                       std::size_t most);

}  // namespace gonio::table
