#include "bench/scaled_fresnel.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "brdf/ashikhmin_shirley.h"
#include "table/file_error.h"

namespace gonio::bench {
namespace {

constexpr double largest_exponent = 1e6;
/// Digits of an exponent or F0, in bits: a minimum is no better known than to half of double's.
constexpr int bits = 26;

/// A minimum on [0, 1]: of the best of `steps` + 1 values, refined between its neighbours.
double minimum(const std::function<double(double)>& cost, int steps) {
  int best = 0;
  double least = cost(0);
  for (int k = 1; k <= steps; ++k) {
    const double value = cost(double(k) / steps);
    if (value >= least) continue;
    least = value;
    best = k;
  }
  const double lower = std::max(0.0, double(best - 1) / steps);
  const double upper = std::min(1.0, double(best + 1) / steps);
  const auto [refined, value] = boost::math::tools::brent_find_minima(cost, lower, upper, bits);
  return value < least ? refined : double(best) / steps;
}

/// The sums that the squared residuals of a channel are made of, over the basis functions lambert,
/// lobe times 1 - (1 - h.wi)^5, lobe times (1 - h.wi)^5, all times cos_i.
struct Sums {
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  Eigen::Vector3d with_measured = Eigen::Vector3d::Zero();
  double measured_square = 0;
  double weight = 0;
};

std::vector<Sums> sums_of(const table::SampleTable& table, const table::SampleFilter& is_used,
                          double n) {
  using Lobe = brdf::AshikhminShirley<brdf::IsotropicExponent>;
  std::vector<Sums> channels(table.channels.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!is_used(i)) continue;
    const auto lobe = Lobe::basis(std::array{n}, table.wi[i], table.wo[i]);
    const double cos_i = table.wi.z[i];
    const Eigen::Vector3d basis(cos_i * std::numbers::inv_pi, cos_i * lobe[0], cos_i * lobe[1]);
    const Eigen::Matrix3d products = basis * basis.transpose();
    const double weight = table.has_weight() ? table.weight[i] : 1;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double measured = table.values[c][i] * cos_i;
      if (std::isnan(measured)) continue;
      channels[c].products += weight * products;
      channels[c].with_measured += weight * measured * basis;
      channels[c].measured_square += weight * measured * measured;
      channels[c].weight += weight;
    }
  }
  return channels;
}

/// The amplitudes of a channel that fit best, and the sum of squares that they leave.
struct Amplitudes {
  double kd = 0, ks = 0;
  double squares = 0;
};

/// Non-negative least squares of two unknowns: where the free minimum has a negative one, the best
/// lies on an axis.
Amplitudes amplitudes_of(const Sums& sums, double f0) {
  const Eigen::Vector3d fresnel(0, f0, 1);
  const double aa = sums.products(0, 0);
  const double ab = sums.products.row(0).dot(fresnel);
  const double bb = fresnel.dot(sums.products * fresnel);
  const double ay = sums.with_measured[0];
  const double by = sums.with_measured.dot(fresnel);
  const auto with = [&](double kd, double ks) -> Amplitudes {
    const double squares = sums.measured_square - 2 * (kd * ay + ks * by) + kd * kd * aa +
                           2 * kd * ks * ab + ks * ks * bb;
    return {kd, ks, squares};
  };
  const double determinant = aa * bb - ab * ab;
  if (determinant > 0) {
    const double kd = (bb * ay - ab * by) / determinant;
    const double ks = (aa * by - ab * ay) / determinant;
    if (kd >= 0 && ks >= 0) return with(kd, ks);
  }
  const Amplitudes diffuse = with(aa > 0 ? std::max(0.0, ay / aa) : 0, 0);
  const Amplitudes lobe = with(0, bb > 0 ? std::max(0.0, by / bb) : 0);
  return diffuse.squares <= lobe.squares ? diffuse : lobe;
}

double squares_of(const std::vector<Sums>& channels, double f0) {
  double sum = 0;
  for (const Sums& sums : channels) sum += amplitudes_of(sums, f0).squares;
  return sum;
}

/// Small F0 are searched more finely than large ones.
double f0_at(double position) { return position * position * position; }

double best_f0(const std::vector<Sums>& channels) {
  return f0_at(minimum([&](double p) { return squares_of(channels, f0_at(p)); }, 50));
}

double exponent_at(double position) { return std::expm1(position * std::log1p(largest_exponent)); }

}  // namespace

ScaledFresnelFit fit_scaled_fresnel(const table::SampleTable& table, double max_theta_deg) {
  const table::SampleFilter is_used(table, max_theta_deg);
  const auto squares_at = [&](double position) {
    const std::vector<Sums> channels = sums_of(table, is_used, exponent_at(position));
    return squares_of(channels, best_f0(channels));
  };
  ScaledFresnelFit fit;
  fit.n = exponent_at(minimum(squares_at, 100));
  const std::vector<Sums> channels = sums_of(table, is_used, fit.n);
  fit.f0 = best_f0(channels);
  double weight = 0;
  for (const Sums& sums : channels) {
    const Amplitudes amplitudes = amplitudes_of(sums, fit.f0);
    fit.kd.push_back(amplitudes.kd);
    fit.ks.push_back(amplitudes.ks);
    weight += sums.weight;
  }
  if (weight == 0) {
    throw table::FileError(fmt::format("{}: no measured value with angles up to {} deg",
                                       table.provenance.path, max_theta_deg));
  }
  fit.error = std::sqrt(std::max(0.0, squares_of(channels, fit.f0)) / weight);
  return fit;
}

}  // namespace gonio::bench
