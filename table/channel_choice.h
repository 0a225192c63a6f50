// Choosing channels of a table as a user names them.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "table/sample_table.h"

namespace gonio::table {

/// The positions of the channels that `choice` names, in the order of the choice, each once: a
/// comma-separated list of
///   R            a channel's name
///   R..B         from one channel to another, in the table's order
///   500nm..600nm all channels with a wavelength within the range, ends included
///   550nm        the channel of that wavelength to 0.5 nm
/// Throws std::invalid_argument that names what was not found and what there is.
std::vector<std::size_t> chosen_channels(std::span<const std::string> channels,
                                         std::string_view choice);

/// Leaves the table with these channels, in this order. A sample that has none of them measured
/// becomes a hole.
void keep_channels(SampleTable& table, std::span<const std::size_t> kept);

}  // namespace gonio::table
