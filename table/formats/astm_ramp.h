// The ramp that goniometer software writes where the instrument did not measure: from the last
// measured polar angle T to the horizon, f(T) (90 deg - theta) / (90 deg - T).
#pragma once

#include <cstddef>
#include <optional>

#include "table/sample_table.h"

namespace gonio::table {

struct Ramp {
  /// T, the last polar angle of wo that was measured, in degrees.
  double last_measured_deg;
  /// How many samples lie beyond it.
  std::size_t samples;
};

/// Looks for the ramp along the meridians (one wi, one azimuth of wo) of the table. On some it is
/// exact to rounding; on others, interpolated ones, it is followed loosely. A straight fall to
/// zero over a whole meridian is taken for measured. Masks the samples beyond T as extrapolated.
std::optional<Ramp> mask_ramp(SampleTable& table);

}  // namespace gonio::table
