// The error of a table's Ward lobe, against the lobe in closed form.
#pragma once

#include <algorithm>
#include <cmath>

#include "lut/table.h"

namespace gonio::tests {

/// exp(-tan^2 / alpha^2) for w = 1 - n.h.
inline double lobe_at(double w, double alpha) {
  const double cosine = 1 - w;
  return std::exp(-w * (2 - w) / (cosine * cosine * alpha * alpha));
}

/// The same by a table of ward-exponent or ward-lobe.
inline double table_lobe_at(const lut::Table& table, double w, double alpha, lut::Filter filter,
                            lut::Weights weights) {
  const double value = lut::look_up(table, w, alpha, filter, weights)[0];
  if (table.layout.kind == lut::TableKind::ward_lobe) return value;
  const bool is_beyond = value <= double{lut::end_of_exponent(table.layout)};
  return is_beyond ? 0 : std::exp(value / (alpha * alpha));
}

/// The largest error, as a fraction of the peak, over n.h from 1 to 0: at 200,000 angles, dense
/// near the peak, hundreds between any two of 512 texels.
inline double worst_lobe_error(const lut::Table& table, double alpha, lut::Filter filter,
                               lut::Weights weights) {
  constexpr int angles = 200000;
  double worst = 0;
  for (int i = 0; i < angles; ++i) {
    const double root = static_cast<double>(i) / angles;
    const double w = root * root;
    const double found = table_lobe_at(table, w, alpha, filter, weights);
    worst = std::max(worst, std::abs(found - lobe_at(w, alpha)));
  }
  return worst;
}

/// A table of 512 texels for one alpha; `reaches_lobe`: as far as that needs, else to n.h = 0.
inline lut::Table table_of_512(lut::TableKind kind, lut::Coordinate coordinate,
                               lut::Storage storage, double alpha, bool reaches_lobe) {
  lut::Layout layout{.kind = kind,
                     .coordinate = coordinate,
                     .storage = storage,
                     .lowest = alpha,
                     .highest = alpha};
  if (reaches_lobe) layout.reach = lut::lobe_reach(layout);
  return lut::bake(layout);
}

}  // namespace gonio::tests
