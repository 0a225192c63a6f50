#include "table/formats/astm_ramp.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <vector>

namespace gonio::table {

namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;
constexpr double angle_tolerance_deg = 1e-6;
/// Of the constant v / (90 deg - theta): angles printed to 15 digits leave 1e-12 of it.
constexpr double exact_tolerance = 1e-9;
/// Three points lie on a straight line by chance sooner than four.
constexpr std::size_t fewest_points = 4;
constexpr std::size_t fewest_meridians = 3;
constexpr double least_share_of_meridians = 0.05;
/// Interpolated meridians of real files deviate by 1 to 2 %.
constexpr double largest_median_deviation = 0.1;

struct Point {
  std::size_t sample;
  double theta_deg;
  double elevation_deg;  // 90 deg - theta, without the rounding of that difference
};

/// Samples of one wi and one azimuth of wo, by rising theta; none at the horizon.
using Meridian = std::vector<Point>;

/// An angle to the tolerance, so that equal ones compare equal.
long long tick(double degrees) { return std::llround(degrees / angle_tolerance_deg); }

std::vector<Meridian> meridians(const SampleTable& table) {
  using Key = std::tuple<double, double, double, long long>;
  std::map<Key, Meridian> by_key;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.mask[i] != MaskReason::none) continue;
    const auto wi = table.wi[i];
    const auto wo = table.wo[i];
    const double sine = std::hypot(wo.x, wo.y);
    // phi = -180 deg and 180 deg are one azimuth.
    const long long phi =
        std::max(tick(std::atan2(wo.y, wo.x) * degrees_per_radian), tick(-180) + 1);
    const long long azimuth = phi == tick(-180) + 1 ? tick(180) : phi;
    by_key[{wi.x, wi.y, wi.z, azimuth}].push_back({i, std::atan2(sine, wo.z) * degrees_per_radian,
                                                   std::atan2(wo.z, sine) * degrees_per_radian});
  }
  std::vector<Meridian> result;
  for (auto& [key, meridian] : by_key) {
    std::sort(meridian.begin(), meridian.end(),
              [](const Point& a, const Point& b) { return a.theta_deg < b.theta_deg; });
    result.push_back(std::move(meridian));
  }
  return result;
}

/// True if both points lie on one line to zero at the horizon, in every channel.
bool on_one_ramp(const SampleTable& table, const Point& a, const Point& b) {
  bool is_all_zero = true;
  for (const std::vector<double>& channel : table.values) {
    const double slope_a = channel[a.sample] / a.elevation_deg;
    const double slope_b = channel[b.sample] / b.elevation_deg;
    if (!(std::abs(slope_a - slope_b) <= exact_tolerance * std::abs(slope_b))) return false;
    is_all_zero = is_all_zero && slope_b == 0;
  }
  return !is_all_zero;
}

/// The first point of the longest exact ramp at the meridian's end, unless it fills the meridian.
std::optional<Point> ramp_start(const SampleTable& table, const Meridian& meridian) {
  std::size_t first = meridian.size() - 1;
  while (first > 0 && on_one_ramp(table, meridian[first - 1], meridian.back())) --first;
  if (first == 0 || meridian.size() - first < fewest_points) return std::nullopt;
  return meridian[first];
}

/// The start that most meridians agree on, in degrees, if they are enough.
std::optional<double> agreed_start(const SampleTable& table,
                                   const std::vector<Meridian>& all_meridians) {
  std::map<long long, std::pair<std::size_t, double>> votes;
  for (const Meridian& meridian : all_meridians) {
    if (const auto start = ramp_start(table, meridian)) {
      auto& [count, theta_deg] = votes[tick(start->theta_deg)];
      ++count;
      theta_deg = start->theta_deg;
    }
  }
  const auto most = std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
    return a.second.first < b.second.first;
  });
  if (most == votes.end()) return std::nullopt;
  const auto [count, theta_deg] = most->second;
  const double share = static_cast<double>(count) / static_cast<double>(all_meridians.size());
  if (count < fewest_meridians || share < least_share_of_meridians) return std::nullopt;
  return theta_deg;
}

/// Appends the relative deviations from the ramp that starts at `start_deg`, of the samples
/// beyond it.
void append_deviations(const SampleTable& table, const Meridian& meridian, double start_deg,
                       std::vector<double>& deviations) {
  const auto start = std::find_if(meridian.begin(), meridian.end(), [&](const Point& p) {
    return std::abs(p.theta_deg - start_deg) <= angle_tolerance_deg;
  });
  if (start == meridian.end()) return;
  for (const std::vector<double>& channel : table.values) {
    const double slope = channel[start->sample] / start->elevation_deg;
    for (auto point = start + 1; point != meridian.end(); ++point) {
      const double expected = slope * point->elevation_deg;
      const double deviation = std::abs(channel[point->sample] / expected - 1);
      if (!std::isnan(deviation)) deviations.push_back(deviation);  // NaN: a hole, or 0 for 0
    }
  }
}

/// True if what lies beyond the start follows the ramp loosely on the meridians as a whole.
bool is_followed(const SampleTable& table, const std::vector<Meridian>& all_meridians,
                 double start_deg) {
  std::vector<double> deviations;
  for (const Meridian& meridian : all_meridians) {
    const auto own_start = ramp_start(table, meridian);
    if (own_start && tick(own_start->theta_deg) == tick(start_deg)) continue;
    append_deviations(table, meridian, start_deg, deviations);
  }
  if (deviations.empty()) return true;
  const auto middle = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2);
  std::nth_element(deviations.begin(), middle, deviations.end());
  return *middle < largest_median_deviation;
}

}  // namespace

std::optional<Ramp> mask_ramp(SampleTable& table) {
  const std::vector<Meridian> all_meridians = meridians(table);
  const auto start_deg = agreed_start(table, all_meridians);
  if (!start_deg || !is_followed(table, all_meridians, *start_deg)) return std::nullopt;
  Ramp ramp{*start_deg, 0};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto wo = table.wo[i];
    const double theta_deg = std::atan2(std::hypot(wo.x, wo.y), wo.z) * degrees_per_radian;
    if (theta_deg <= *start_deg + angle_tolerance_deg) continue;
    table.mask[i] = MaskReason::extrapolated;
    ++ramp.samples;
  }
  return ramp;
}

}  // namespace gonio::table
