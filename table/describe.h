// What a table is, before anything is fitted to it: ranges, coverage, plausibility.
//
// Everything here looks at unmasked samples only. Angles are in degrees, values are f_r in 1/sr.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "table/reciprocity.h"
#include "table/sample_table.h"

namespace gonio::table {

/// A closed range; both ends are 0 where there is nothing to range over.
struct Range {
  double minimum = 0;
  double maximum = 0;
};

/// One channel over the unmasked samples.
struct ChannelSummary {
  std::string name;
  Range value{};             // f_r in 1/sr over the measured samples
  std::size_t measured = 0;  // samples with a value
  std::size_t negative = 0;  // measured samples below 0
  std::size_t holes = 0;     // samples without a value
};

/// The exitant directions that share an incidence angle, or a 15-degree bin of it. Azimuths are
/// taken relative to wi, so that different rotations of the sample fall on one hemisphere.
struct IncidenceSummary {
  double theta_deg = 0;  // the incidence angle, or the centre of the bin
  std::size_t samples = 0;
  std::size_t azimuths = 0;  // azimuths of incidence, counted in whole degrees
  std::size_t cells = 0;     // equal-area cells of the projected disc that coverage counts
  double coverage = 0;       // the share of them that holds a sample
  // The directional albedo per channel: pi times the mean of f_r over the projected disc, where a
  // direction that was not measured counts like the nearest one that was. An estimate; empty if
  // coverage is below 1/4, and none for a channel of nothing but holes here.
  std::vector<std::optional<double>> albedo{};
};

/// Which slopes of the half vector the table holds, hx/hz along the tangent and hy/hz along the
/// bitangent: alpha_x and alpha_y can be told apart only with both.
struct HalfVectorCoverage {
  std::size_t along_x = 0;  // samples whose half vector leans within 30 deg of the x axis
  std::size_t along_y = 0;  // the same for the y axis
  bool both = false;        // at least 10 samples and 1 % of all used ones along each
};

struct Description {
  std::size_t samples = 0;
  std::size_t used = 0;  // unmasked
  std::array<std::size_t, mask_reason_count> masked{};
  Range theta_i_deg;
  Range theta_o_deg;
  std::vector<ChannelSummary> channels;
  /// True if the incidence angles are too many to list and were put into 15-degree bins.
  bool incidence_binned = false;
  std::vector<IncidenceSummary> incidences;
  /// Empty where the table holds no pairs to test with.
  std::optional<Reciprocity> reciprocity;
  HalfVectorCoverage half_vectors;
  /// What looks wrong with the numbers, one sentence each; what the reader noted is not repeated.
  std::vector<std::string> warnings;
};

/// Describes `table`. Never throws for a valid SampleTable, even if every sample is masked. Under
/// a second for a million samples of three channels.
Description describe(const SampleTable& table);

}  // namespace gonio::table
