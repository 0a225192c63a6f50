// Tables made of tables: a part of one, several put together.
#pragma once

#include <functional>
#include <span>

#include "table/sample_table.h"

namespace gonio::table {

/// Leaves the table with the samples that `is_kept` is true of, in their order.
void keep_samples(SampleTable& table, const std::function<bool(std::size_t)>& is_kept);

/// Leaves the table with the samples whose polar angles are both at most `max_theta_deg`
/// (inclusive, + 1e-6 deg), masked or not.
void crop(SampleTable& table, double max_theta_deg);

/// All the samples of several tables of one material, one table after the other. They need the same
/// channels, in any order, and all of them sigma, or none, and weights, or none; the texts of their
/// angles are kept where all have some in the same unit. Throws FileError that names the table that
/// differs.
SampleTable merge(std::span<SampleTable> tables);

}  // namespace gonio::table
