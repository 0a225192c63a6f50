// What a table is, before anything is fitted to it: ranges, coverage, plausibility.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "table/sample_table.h"

namespace gonio::table {

struct Range {
  double minimum, maximum;
};

struct ChannelSummary {
  std::string name;
  Range value;  // f_r in 1/sr over unmasked samples
  std::size_t measured, negative, holes;
};

/// How many exitant directions share an incidence angle.
struct IncidenceSummary {
  double theta_deg;            // the incidence angle, or the centre of a 15-degree bin
  std::size_t samples;
  std::size_t incidence_azimuths;  // distinct, to 0.1 deg (capped at 360)
  double coverage;             // share of the hemisphere's projected solid angle with samples
  std::vector<double> albedo;  // per channel, estimated over what is covered; empty if hopeless
};

struct Reciprocity {
  std::size_t pairs;
  double rms_relative;   // RMS of |f - f'| / mean(|f|, |f'|)... over the pairs and channels
  bool assumed_isotropy; // the pairs exist only if the sample may be turned
};

struct Description {
  std::size_t samples, used;
  std::array<std::size_t, mask_reason_count> masked;
  Range theta_i_deg, theta_o_deg;
  std::size_t incidence_directions;
  std::vector<ChannelSummary> channels;
  std::vector<IncidenceSummary> incidences;
  std::optional<Reciprocity> reciprocity;
  std::vector<std::string> warnings;  // implausible albedo, large negative share, ...
};

Description describe(const SampleTable& table);

}  // namespace gonio::table
