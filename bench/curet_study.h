// Rough surfaces: how much better than Lambert's model those of Oren and Nayar describe them, on
// CUReT's materials. Both contain it (sigma = 0), so that neither may ever be worse.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fit/options.h"
#include "table/sample_table.h"

namespace gonio::bench {

inline constexpr std::array<std::string_view, 3> rough_models{"lambert", "oren-nayar",
                                                              "oren-nayar-full"};

/// A model fitted to a material.
struct RoughFit {
  /// Root mean square under the metric, in 1/sr.
  double error = 0;
  /// In rad; none for lambert. The deviation is missing where sigma cannot be determined.
  std::optional<double> sigma, sigma_stddev;
  bool converged = false;
};

struct RoughMaterial {
  std::string name;
  std::size_t used = 0;
  /// As in rough_models.
  std::array<RoughFit, rough_models.size()> fits;
};

/// Fits every model to every table. The result is the same for any number of threads (0: as many as
/// the machine has).
std::vector<RoughMaterial> study_roughness(std::span<const table::SampleTable> tables,
                                           fit::Metric metric, double max_theta_deg, int threads);

/// On how many materials `model` is better, as good to rounding (1e-12), and worse than
/// `reference`. Both are indices into rough_models.
struct Tally {
  std::size_t better = 0, equal = 0, worse = 0;
};
Tally tally(std::span<const RoughMaterial> materials, std::size_t model, std::size_t reference);

/// Of the ratios of the errors of `model` and `reference` over all materials.
double geometric_mean_ratio(std::span<const RoughMaterial> materials, std::size_t model,
                            std::size_t reference);

}  // namespace gonio::bench
