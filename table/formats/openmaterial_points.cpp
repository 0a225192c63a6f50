#include "table/formats/openmaterial_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>

namespace gonio::table {

namespace {

/// Rounding of angles that are computed from components.
constexpr double same_angle = 1e-14;
/// The limits of the standard, which are pi/2 and 2 pi rounded down.
constexpr double largest_zenith = 1.570796;
constexpr double largest_azimuth = 6.283185;

struct Placed {
  RelativeAngles angles;
  std::size_t sample;
};

double zenith_of(const brdf::Direction<double>& d) { return std::atan2(std::hypot(d.x, d.y), d.z); }

/// How far apart two azimuths are that differ by rounding of the directions' components.
double azimuth_tolerance(double theta_i, double theta_o) {
  constexpr double largest = 1e-9;
  const double sines = std::sin(theta_i) * std::sin(theta_o);
  return sines * largest > same_angle ? same_angle / sines : largest;
}

/// From 0 to below 2 pi. An azimuth that one of the directions lacks is 0.
double relative_azimuth(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo) {
  constexpr double pole = 1e-15;
  if (std::hypot(wo.x, wo.y) < pole) return 0;
  const double phi = std::hypot(wi.x, wi.y) < pole
                         ? std::atan2(wo.y, wo.x)
                         : std::atan2(wi.x * wo.y - wi.y * wo.x, wi.x * wo.x + wi.y * wo.y);
  if (phi >= 0) return phi;
  return phi > -azimuth_tolerance(zenith_of(wi), zenith_of(wo)) ? 0 : phi + 2 * std::numbers::pi;
}

/// Brings an azimuth beyond the largest one to the nearer of that and 0.
bool move_into_range(double& phi) {
  if (phi <= largest_azimuth) return false;
  phi = phi - largest_azimuth < 2 * std::numbers::pi - phi ? largest_azimuth : 0;
  return true;
}

bool has_azimuth(const brdf::Direction<double>& wi) {
  constexpr double rounding = 1e-12;
  return std::abs(wi.y) > rounding || wi.x < -rounding;
}

std::vector<Placed> placed_samples(const SampleTable& table, OpenMaterialLoss& loss) {
  std::vector<Placed> placed;
  placed.reserve(table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.mask[i] != MaskReason::none) {
      ++loss.masked;
      continue;
    }
    RelativeAngles angles{zenith_of(table.wi[i]), zenith_of(table.wo[i]), 0};
    if (angles.theta_i >= largest_zenith || angles.theta_o >= largest_zenith) {
      ++loss.at_horizon;
      continue;
    }
    angles.phi = relative_azimuth(table.wi[i], table.wo[i]);
    if (move_into_range(angles.phi)) ++loss.moved_azimuths;
    loss.light_azimuths = loss.light_azimuths || has_azimuth(table.wi[i]);
    placed.push_back({angles, i});
  }
  return placed;
}

/// Gives zeniths that differ by rounding only the least of them.
void unify_zeniths(std::vector<Placed>& placed, double RelativeAngles::*zenith) {
  std::sort(placed.begin(), placed.end(),
            [&](const Placed& a, const Placed& b) { return a.angles.*zenith < b.angles.*zenith; });
  double least = -1;
  for (Placed& one : placed) {
    double& theta = one.angles.*zenith;
    if (theta > least + same_angle) least = theta;
    theta = least;
  }
}

bool is_same(const RelativeAngles& a, const RelativeAngles& b) {
  return a.theta_i == b.theta_i && a.theta_o == b.theta_o &&
         std::abs(a.phi - b.phi) <= azimuth_tolerance(a.theta_i, a.theta_o);
}

}  // namespace

OpenMaterialPoints openmaterial_points(const SampleTable& table, OpenMaterialLoss& loss) {
  std::vector<Placed> placed = placed_samples(table, loss);
  unify_zeniths(placed, &RelativeAngles::theta_i);
  unify_zeniths(placed, &RelativeAngles::theta_o);
  const auto key = [](const Placed& one) {
    return std::tuple(one.angles.theta_i, one.angles.theta_o, one.angles.phi, one.sample);
  };
  std::sort(placed.begin(), placed.end(),
            [&](const Placed& a, const Placed& b) { return key(a) < key(b); });
  OpenMaterialPoints points;
  points.samples.reserve(placed.size());
  for (const Placed& one : placed) {
    if (points.angles.empty() || !is_same(points.angles.back(), one.angles)) {
      points.angles.push_back(one.angles);
      points.first.push_back(points.samples.size());
    }
    points.samples.push_back(one.sample);
  }
  points.first.push_back(points.samples.size());
  for (std::size_t point = 0; point < points.angles.size(); ++point) {
    const std::size_t count = points.samples_of(point).size();
    if (count < 2) continue;
    loss.averaged += count;
    ++loss.averages;
  }
  return points;
}

std::vector<double> openmaterial_values(const OpenMaterialPoints& points,
                                        const std::vector<double>& values, OpenMaterialLoss& loss) {
  std::vector<double> means;
  means.reserve(points.angles.size());
  for (std::size_t point = 0; point < points.angles.size(); ++point) {
    double mean = 0;
    double count = 0;
    for (const std::size_t sample : points.samples_of(point)) {
      if (std::isnan(values[sample])) continue;
      ++count;
      // Not the sum, which may overflow; of one value it is that value.
      mean += values[sample] / count - mean / count;
    }
    if (count == 0) {
      ++loss.holes;
      mean = std::numeric_limits<double>::quiet_NaN();
    } else if (mean < 0) {
      ++loss.negative;
      mean = 0;
    }
    means.push_back(mean);
  }
  return means;
}

}  // namespace gonio::table
