#include "tests/ward_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace gonio::tests {
namespace {

using std::numbers::pi;

/// The least sum of squares of a + b s - y over a, b >= 0, by the moments of the samples.
double least_squares(double n, double s, double ss, double y, double ys, double yy) {
  const auto sum_at = [&](double a, double b) {
    return yy - 2 * a * y - 2 * b * ys + a * a * n + 2 * a * b * s + b * b * ss;
  };
  const double determinant = n * ss - s * s;
  const double a = (ss * y - s * ys) / determinant;
  const double b = (n * ys - s * y) / determinant;
  if (determinant > 1e-12 * n * ss && a >= 0 && b >= 0) return sum_at(a, b);
  return std::min(sum_at(std::max(y / n, 0.0), 0), ss > 0 ? sum_at(0, std::max(ys / ss, 0.0)) : yy);
}

}  // namespace

WardScan::WardScan(const table::SampleTable& table, double max_theta_deg)
    : values_(table.channels.size()) {
  const double min_cos = std::cos((max_theta_deg + 1e-6) * pi / 180);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const brdf::Direction<double> wi = table.wi[i];
    const brdf::Direction<double> wo = table.wo[i];
    if (table.mask[i] != table::MaskReason::none || wi.z < min_cos || wo.z < min_cos) continue;
    const double x = wi.x + wo.x;
    const double y = wi.y + wo.y;
    const double z = wi.z + wo.z;
    const double theta_h = std::atan2(std::hypot(x, y), z);
    const double phi_h = std::atan2(y, x);
    const double tan_h = std::tan(theta_h);
    geometry_.push_back({std::pow(tan_h * std::cos(phi_h), 2), std::pow(tan_h * std::sin(phi_h), 2),
                         wi.z, wo.z, x * x + y * y + z * z, z});
    for (std::size_t c = 0; c < values_.size(); ++c) values_[c].push_back(table.values[c][i]);
  }
}

double WardScan::ward(const Geometry& g, double alpha_x, double alpha_y) {
  return std::exp(-(g.tan2_x / (alpha_x * alpha_x) + g.tan2_y / (alpha_y * alpha_y))) /
         (4 * pi * alpha_x * alpha_y * std::sqrt(g.cos_i * g.cos_o));
}

double WardScan::ward_duer(const Geometry& g, double alpha_x, double alpha_y) {
  return ward(g, alpha_x, alpha_y) / std::sqrt(g.cos_i * g.cos_o);
}

double WardScan::ward_gmd(const Geometry& g, double alpha_x, double alpha_y) {
  return ward_duer(g, alpha_x, alpha_y) * 4 * g.cos_i * g.cos_o * g.half_length2 /
         std::pow(g.half_z, 4);
}

double WardScan::cost(Lobe lobe, double alpha_x, double alpha_y) const {
  const double n = double(geometry_.size());
  double s = 0;
  double ss = 0;
  std::vector<double> y(values_.size());
  std::vector<double> ys(values_.size());
  std::vector<double> yy(values_.size());
  for (std::size_t i = 0; i < geometry_.size(); ++i) {
    const double value = lobe(geometry_[i], alpha_x, alpha_y);
    s += value;
    ss += value * value;
    for (std::size_t c = 0; c < values_.size(); ++c) {
      y[c] += values_[c][i];
      ys[c] += values_[c][i] * value;
      yy[c] += values_[c][i] * values_[c][i];
    }
  }
  double sum = 0;
  for (std::size_t c = 0; c < values_.size(); ++c) {
    sum += least_squares(n, s, ss, y[c], ys[c], yy[c]);
  }
  return sum / 2;
}

double WardScan::least_cost_over_one_roughness(Lobe lobe) const {
  constexpr int points = 600;
  const auto roughness = [](double step) { return 1e-3 * std::pow(5e3, step / (points - 1)); };
  const auto cost_at = [&](double step) { return cost(lobe, roughness(step), roughness(step)); };
  double best = std::numeric_limits<double>::infinity();
  double best_step = 0;
  for (int step = 0; step < points; ++step) {
    const double here = cost_at(step);
    if (here < best) {
      best = here;
      best_step = step;
    }
  }
  double low = best_step - 1;
  double high = best_step + 1;
  const double section = 2 - std::numbers::phi;
  for (int i = 0; i < 40; ++i) {
    const double a = low + section * (high - low);
    const double b = high - section * (high - low);
    const double cost_a = cost_at(a);
    const double cost_b = cost_at(b);
    best = std::min({best, cost_a, cost_b});
    (cost_a < cost_b ? high : low) = cost_a < cost_b ? b : a;
  }
  return best;
}

double WardScan::least_cost_over_both_roughnesses(Lobe lobe) const {
  constexpr int points = 30;
  double centre_x = 0.5;  // shares of the way from 0.005 to 3, in the logarithm
  double centre_y = 0.5;
  double width = 1;
  const auto roughness = [](double share) { return 0.005 * std::pow(600, share); };
  double best = std::numeric_limits<double>::infinity();
  for (int level = 0; level < 3; ++level) {
    const int count = level == 0 ? points : 9;
    const double first_x = centre_x - width / 2;
    const double first_y = centre_y - width / 2;
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        const double share_x = first_x + width * i / (count - 1);
        const double share_y = first_y + width * j / (count - 1);
        const double here = cost(lobe, roughness(share_x), roughness(share_y));
        if (here < best) {
          best = here;
          centre_x = share_x;
          centre_y = share_y;
        }
      }
    }
    width *= 2.0 / (count - 1);
  }
  return best;
}

}  // namespace gonio::tests
