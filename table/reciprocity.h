// Helmholtz reciprocity of a measured table: f_r(wi, wo) = f_r(wo, wi).
#pragma once

#include <cstddef>
#include <optional>

#include "table/sample_table.h"

namespace gonio::table {

struct Reciprocity {
  std::size_t pairs = 0;
  /// RMS over the pairs and channels of |f - f'| / ((|f| + |f'|) / 2); from 0 to 2.
  double rms_relative = 0;
  /// The pairs match only if the sample may be turned and mirrored: (theta_i, theta_o, |dphi|).
  bool assumed_isotropy = false;
};

/// Compares the unmasked samples with those whose light and viewer are swapped; angles match to
/// 0.01 deg, and samples in the same place are averaged first. Takes exact pairs if there are at
/// least 10, else pairs that exist under assumed isotropy; empty if those are fewer than 10 too.
std::optional<Reciprocity> reciprocity_of(const SampleTable& table);

}  // namespace gonio::table
