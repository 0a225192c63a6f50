// The problem that a fit solves, written down plainly: one loop over all the samples in long
// double, the formulas of options.h and of Ward's paper, no packs, chunks, compression or
// projection.
//
// The model is lambert + ward-aniso, with its tangent at psi (0 for the frame of the table).
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fit/options.h"
#include "fit/parameters.h"
#include "table/sample_table.h"

namespace gonio::tests {

/// The residual of a value under a metric; `floor` and `sigma` where the metric needs them.
template <class S>
S plain_residual(fit::Metric metric, double f, const S& model, double cos_i, double floor,
                 double sigma) {
  using std::cbrt;
  using std::log;
  const double seen = std::max(0.0, f * cos_i);
  switch (metric) {
    case fit::Metric::l2:
      return model - f;
    case fit::Metric::cosine_l2:
      return (model - f) * cos_i;
    case fit::Metric::log:
      return log(S(1) + model * cos_i) - std::log(1 + seen);
    case fit::Metric::cube_root:
      return cbrt(model * cos_i) - std::cbrt(seen);
    case fit::Metric::relative:
      return (model - f) / std::max(std::abs(f), floor);
    case fit::Metric::chi2:
      return (model - f) / sigma;
  }
  return S(NAN);
}

/// What a residual costs, as the comment at fit::Loss has it.
inline long double plain_loss(fit::Loss loss, long double scale, long double r) {
  const long double s = (r / scale) * (r / scale);
  switch (loss) {
    case fit::Loss::none:
      return r * r / 2;
    case fit::Loss::huber:
      return scale * scale * (s <= 1 ? s / 2 : std::sqrt(s) - 0.5L);
    case fit::Loss::cauchy:
      return scale * scale * std::log1p(s) / 2;
    case fit::Loss::tukey:
      return scale * scale * (1 - std::pow(std::max(0.0L, 1 - s), 3)) / 6;
  }
  return NAN;
}

/// Ward 1992, eq. 5a, with the tangent at the azimuth psi; S is the scalar of the shape.
template <class S>
S plain_ward(const S& alpha_x, const S& alpha_y, const S& psi, const brdf::Direction<double>& wi,
             const brdf::Direction<double>& wo) {
  using std::cos;
  using std::exp;
  using std::sin;
  const double hz = wi.z + wo.z;
  const double hx = (wi.x + wo.x) / hz;
  const double hy = (wi.y + wo.y) / hz;
  const S u = (cos(psi) * hx + sin(psi) * hy) / alpha_x;
  const S v = (cos(psi) * hy - sin(psi) * hx) / alpha_y;
  return exp(-(u * u + v * v)) /
         (alpha_x * alpha_y * (4 * std::numbers::pi * std::sqrt(wi.z * wo.z)));
}

/// The parameters of lambert + ward-aniso.
struct PlainParameters {
  std::vector<long double> rho_d, rho_s;  // per channel
  long double alpha_x, alpha_y, psi = 0;
};

inline PlainParameters plain(const fit::ParameterValues& values) {
  PlainParameters p;
  for (Eigen::Index c = 0; c < values.amplitudes.cols(); ++c) {
    p.rho_d.push_back(values.amplitudes(0, c));
    p.rho_s.push_back(values.amplitudes(1, c));
  }
  p.alpha_x = values.shape[0];
  p.alpha_y = values.shape[1];
  if (values.shape.size() > 2) p.psi = values.shape[2];
  return p;
}

/// One measured value that takes part.
struct PlainValue {
  brdf::Direction<double> wi, wo;
  std::size_t sample, channel;
  double f, weight, sigma, floor;

  long double model(const PlainParameters& p) const {
    return p.rho_d[channel] / std::numbers::pi_v<long double> +
           p.rho_s[channel] * plain_ward(p.alpha_x, p.alpha_y, p.psi, wi, wo);
  }
  long double residual(fit::Metric metric, const PlainParameters& p) const {
    return plain_residual(metric, f, model(p), wi.z, floor, sigma);
  }
};

/// The values with both polar angles up to 80 degrees that are not masked and were measured.
inline std::vector<PlainValue> plain_values(const table::SampleTable& table,
                                            const std::vector<double>& floors) {
  const double least_cosine = std::cos(80.000001 * std::numbers::pi / 180);
  std::vector<PlainValue> values;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.mask[i] != table::MaskReason::none) continue;
    if (table.wi.z[i] < least_cosine || table.wo.z[i] < least_cosine) continue;
    for (std::size_t c = 0; c < table.channels.size(); ++c) {
      if (std::isnan(table.values[c][i])) continue;
      values.push_back({table.wi[i], table.wo[i], i, c, table.values[c][i],
                        table.has_weight() ? table.weight[i] : 1,
                        table.has_sigma() ? table.sigma[c][i] : 1, floors[c]});
    }
  }
  return values;
}

inline long double plain_cost(const std::vector<PlainValue>& values, fit::Metric metric,
                              fit::Loss loss, long double scale, const PlainParameters& p) {
  long double cost = 0;
  for (const PlainValue& value : values) {
    cost += value.weight * plain_loss(loss, scale, value.residual(metric, p));
  }
  return cost;
}

/// The lower median of non-negative numbers, in full precision.
inline double plain_median(std::vector<double> magnitudes) {
  const auto middle = magnitudes.begin() + std::ptrdiff_t((magnitudes.size() - 1) / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return *middle;
}

/// 1 % of each channel's median |f| that is not 0.
inline std::vector<double> plain_floors(const table::SampleTable& table) {
  std::vector<std::vector<double>> magnitudes(table.channels.size());
  for (const PlainValue& value :
       plain_values(table, std::vector<double>(table.channels.size(), 0.0))) {
    if (value.f != 0) magnitudes[value.channel].push_back(std::abs(value.f));
  }
  std::vector<double> floors;
  for (std::vector<double>& channel : magnitudes) {
    floors.push_back(0.01 * plain_median(std::move(channel)));
  }
  return floors;
}

}  // namespace gonio::tests
