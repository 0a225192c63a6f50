// The samples of a table as rows of an OpenMATERIAL 3D table, which knows no azimuth of the light.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "table/formats/openmaterial_grid.h"
#include "table/formats/openmaterial_writer.h"
#include "table/sample_table.h"

namespace gonio::table {

/// Samples that share their angles, by zeniths and azimuth of the light's side.
struct OpenMaterialPoints {
  std::vector<RelativeAngles> angles;  // ascending by theta_i, theta_o, phi, all different
  std::vector<std::size_t> samples;    // those of the first point, of the second ..
  std::vector<std::size_t> first;      // of each point in `samples`, and the end

  std::span<const std::size_t> samples_of(std::size_t point) const {
    return std::span(samples).subspan(first[point], first[point + 1] - first[point]);
  }
};

/// Those samples that are not masked and away from the horizon. Angles that differ by rounding, up
/// to 1e-14, become equal. Counts in `loss` what is lost of directions.
OpenMaterialPoints openmaterial_points(const SampleTable& table, OpenMaterialLoss& loss);

/// The values of a channel for each point: the mean of its samples; NaN where none was measured, 0
/// for a negative one. Counts both in `loss`.
std::vector<double> openmaterial_values(const OpenMaterialPoints& points,
                                        const std::vector<double>& values, OpenMaterialLoss& loss);

}  // namespace gonio::table
