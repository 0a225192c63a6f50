// The smallest look-up table that is good enough for a material.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "brdf/bound_model.h"
#include "trade/reference.h"
#include "trade/table_check.h"

namespace gonio::trade {

/// What is asked of a table.
struct TableLimits {
  /// The largest error, as a fraction of the lobe's peak.
  double largest = half_display_step;
  /// Root mean square of f_r cos_i in 1/sr; none where there is no residual to compare with.
  std::optional<double> rms = {};
};

/// Of a fit's residual: a table that stays below changes the fit's error by 1/20000 of itself.
inline constexpr double share_of_residual = 0.01;

/// Whether a fit's residual limits the root mean square of a table's error, or why it does not.
enum class ResidualUse {
  limits,
  unknown,                // there is none
  over_other_directions,  // than the reference's root mean squares: it has no samples
  below_float             // its share is less than what a shader's arithmetic in float costs
};

/// A shader's arithmetic in float changes f_r by about this share of itself: sixteen roundings.
inline constexpr double share_of_float = 0x1p-20;

ResidualUse residual_use(const Reference& reference, const std::optional<double>& residual);

/// The limits for a tolerance and a fit's residual.
TableLimits limits_of(const Reference& reference, double tolerance,
                      const std::optional<double>& residual);

/// What is asked of a prediction: 5 % less, as a device's arithmetic in float comes on top of it.
TableLimits with_headroom(const TableLimits& limits);

/// True if the errors are within the limits.
bool keeps(const TableLimits& limits, const EvaluatorError& error);

/// A table that keeps the limits, and its predicted error: the larger one of exact weights and of
/// those rounded to 1/256.
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
