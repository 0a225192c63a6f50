// A model whose lobe is read from a table: what a shader with that table computes.
//
// With h = wi + wo, w = 1 - n.h = (hx^2 + hy^2) / (|h| (|h| + hz)):
//
//   ward          k = 1/alpha^2, or ((hx/alpha_x)^2 + (hy/alpha_y)^2) / (hx^2 + hy^2) for an
//                 anisotropic lobe, 1/alpha_x^2 where hx = hy = 0
//                 ward-exponent: t at w; E = exp(k min(t, 0)), and 0 where t <= end_of_exponent()
//                 ward-lobe: E at w in the row alpha = k^(-1/2)
//                 f_r = rho_s E / (the denominator of the model, as computed)
//   blinn-phong   f_r = ks times the power at w in the row of its exponent
//   strauss       with strauss-j: j and 1 - F at (w of wi, w of wo); with strauss-terms: d Rd and
//                 r at (s, m); all else computed:
//                 R = min(1, r + j (r + 0.1)), f_r = d Rd c / pi + lobe R / pi
//                 ((1 - m) / cos_i + m (1 - (1 - F)) / cos_i + c m (1 - F) / cos_i)
#pragma once

#include <span>

#include "brdf/bound_model.h"
#include "lut/table.h"

namespace gonio::lut {

/// Throws std::invalid_argument if no term of the model is in the table (layout_for), or the
/// table's alphas, exponents, argument or transparency are not the material's.
void require_serves(const brdf::BoundModel& model, const Table& table);

/// Evaluates in double all but the table's texels, so that its difference from the model is the
/// error of the table alone. Every term of the model that the table serves is read from it; the
/// others are computed.
class TableModel {
 public:
  /// The table must outlive it. Throws as require_serves().
  TableModel(const brdf::BoundModel& model, const Table& table, Filter filter, Weights weights);
  TableModel(const brdf::BoundModel&, Table&&, Filter, Weights) = delete;

  /// As brdf::BoundModel::f_r: in 1/sr, every channel, finite, 0 below the horizon.
  void f_r(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
           std::span<double> values) const;

 private:
  brdf::BoundModel model_;
  const Table* table_;
  Filter filter_;
  Weights weights_;
};

}  // namespace gonio::lut
