// The smallest look-up table that is good enough for a material.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "brdf/bound_model.h"
#include "trade/reference.h"
#include "trade/table_check.h"

namespace gonio::trade {

/// What is asked of a table; its errors are those predicted with weights rounded to 1/256.
struct TableLimits {
  /// The largest error, as a fraction of the lobe's peak.
  double largest = half_display_step;
  /// Root mean square of f_r cos_i in 1/sr; none where there is no residual to compare with.
  std::optional<double> rms = {};
};

/// Of a fit's residual: a table that stays below changes the fit's error by 1/20000 of itself.
inline constexpr double share_of_residual = 0.01;

/// The limits for a tolerance and a fit's residual: 5 % below them, as a device's arithmetic in
/// float comes on top of what is predicted.
TableLimits limits_of(double tolerance, const std::optional<double>& residual);

/// True if the errors are within the limits.
bool keeps(const TableLimits& limits, const EvaluatorError& error);

/// A table that keeps the limits, and its predicted error.
struct GoodTable {
  TableChoice table;
  std::size_t bytes;
  EvaluatorError error;
};

/// No larger table is looked at: it would crowd all else out of a GPU's nearest cache.
inline constexpr std::size_t most_bytes = std::size_t(256) << 10;

/// For each storage format the smallest table that keeps the limits, the smallest of them first:
/// of the model's kinds of table, the widths from 16 to 4096 in powers of two, heights where a
/// range of parameters needs them, every coordinate but the listing's, both reaches, both filters.
/// Of equally small ones the one that is cheapest to read: linear, cosine before the roots. Empty
/// if there is none. Throws std::invalid_argument for a model without tables.
std::vector<GoodTable> smallest_tables(const brdf::BoundModel& model, const Reference& reference,
                                       const TableLimits& limits);

}  // namespace gonio::trade
