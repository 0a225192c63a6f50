// How much of a fitted material's error its look-up table is: for every material the table that
// `gonio lut check --recommend` chooses, and its root mean square error beside the fit's residual.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shader/vulkan_device.h"
#include "trade/table_check.h"

namespace gonio::bench {

/// A table of measurements and the model that is fitted to it.
struct MeasuredMaterial {
  std::string path;
  std::string model;
};

/// Ward's ten materials with 2 % of noise, from the project's folder: each with the model that its
/// recipe names.
std::vector<MeasuredMaterial> ward_materials(const std::string& project);

/// Five paints, from the folder of measurements; empty where they are not.
std::vector<MeasuredMaterial> paints(const std::string& data);

/// What came of one material. The errors are over its own samples (trade/reference.h).
struct TableResidual {
  std::string name;
  std::string model;
  double residual = 0;  // of the fit: root mean square of (measured - model) cos_i, in 1/sr
  /// With the recommended table; none if there is no such table.
  std::optional<trade::TableCheck> check;

  /// Root mean square of the table's error per residual; infinite without a table.
  double share() const;
};

/// Fits under cosine-l2, which makes that residual as small as it can be, and measures the table on
/// the device if there is one. Throws as table::read and fit::fit.
TableResidual table_residual(const MeasuredMaterial& material, shader::VulkanDevice* device);

/// The figure: the table's share of the residual.
bool figure_holds(const TableResidual& result);

}  // namespace gonio::bench
