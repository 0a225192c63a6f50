// A gridded table as a function of direction: f_r between the nodes, as the file's format defines
// it.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "brdf/direction.h"
#include "table/sample_table.h"

namespace gonio::table {

struct GriddedTable {
  std::string name;
  std::vector<std::string> channels;
  /// Writes f_r in 1/sr of every channel for unit directions. A quiet NaN is a channel that was not
  /// measured there; all are for a direction at the horizon or below it, or beyond the grid. Does
  /// not allocate; several threads may call it at once.
  std::function<void(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                     std::span<double> f_r)>
      f_r;
  /// What the reader has to tell the user, one sentence each.
  std::vector<std::string> notes;
  Provenance provenance;
};

}  // namespace gonio::table
