// Writing a table as a MERL `.binary` (merl.h), and what that format does not hold.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "table/sample_table.h"

namespace gonio::table {

/// What became of a table in a MERL file.
struct MerlLoss {
  std::size_t samples = 0;
  std::size_t written = 0;  // samples that a bin holds, alone or in a mean
  std::size_t holes = 0;    // samples without a value in any channel
  std::size_t dropped = 0;  // samples with a value that were left out, since they are masked
  std::size_t moved = 0;    // written samples that do not stand at the node of their bin
  double largest_move_deg = 0;
  std::size_t merged = 0;   // written samples that share their bin: it holds their mean
  std::size_t turned = 0;   // written samples whose half vector has another azimuth than 0
  std::size_t clamped = 0;  // negative values, which MERL takes for no measurement: 0 was written
  std::size_t bins = 0;
  std::size_t filled = 0;  // bins with a value in any channel; the others hold -1
  bool lost_sigma = false;
  bool lost_weight = false;  // weights that are not those which reading the file gives
  /// The table's channels where they are not called R, G, B: they were written as those.
  std::vector<std::string> renamed;
};

/// Writes a table of three channels, which become R, G and B in their order, through `write`, in
/// pieces. Each sample goes to its bin (merl_place); where wi and wo are one direction, which
/// leaves phi_d open, the samples of a row fill its bins in order. A table that was read from a
/// MERL file gives a file that reads back to the same bits of f_r; the values in the file may
/// differ in their last bit where two of them read as the same f_r. Values are kept below the
/// horizon, too, for samples that stand at a node. Throws FileError, before anything is written,
/// for another number of channels and for values that are too large.
MerlLoss write_merl(const SampleTable& table, const std::function<void(std::string_view)>& write);

/// What was lost, a sentence each; nothing for a table that was read from a MERL file.
std::vector<std::string> describe(const MerlLoss& loss);

}  // namespace gonio::table
