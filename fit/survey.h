// What there is to fit: counted once per fit, before anything is weighed.
#pragma once

#include <cstddef>
#include <vector>

#include "brdf/direction.h"
#include "table/sample_table.h"

namespace gonio::fit {

struct Survey {
  /// Samples used, and measured values among them (all channels).
  std::size_t used_samples = 0;
  std::size_t used_values = 0;
  /// Some channel of some used sample was not measured.
  bool has_holes() const { return holes > 0; }
  std::size_t holes = 0;
  /// The measured values of each channel.
  std::vector<std::size_t> channel_values;
  /// The largest |f_r| that is used.
  double largest = 0;
  /// The largest weight of a used sample; 1 where the table carries none.
  double largest_weight = 0;
  /// Of the used samples, the light that comes at the largest angle.
  brdf::Direction<double> most_grazing_wi{0, 0, 1};
};

/// The same for any number of threads. Throws table::FileError if no sample is left, or if the
/// values are so large or so small that their squares leave the range of double.
Survey survey_of(const table::SampleTable& table, const table::SampleFilter& filter, int threads);

/// Per channel the least magnitude that the relative metric divides by: 1 % of the median |f_r| of
/// the used values that are not 0 (a clamped instrument may read 0 in most places); 1e300 where
/// there is none, as a channel that is 0 everywhere has no relative error.
std::vector<double> relative_floors(const table::SampleTable& table,
                                    const table::SampleFilter& filter, int threads);

}  // namespace gonio::fit
