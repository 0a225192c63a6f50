#include "table/reciprocity.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace gonio::table {
namespace {

constexpr std::size_t fewest_pairs = 10;
constexpr double cells_per_radian = 180 / std::numbers::pi * 100;  // 0.01 deg
constexpr std::int64_t full_turn = 36000;

/// A direction in whole hundredths of a degree; the azimuth of the normal is 0.
struct GridAngles {
  std::int64_t theta, phi;
};

GridAngles grid_angles(const brdf::Direction<double>& d) {
  const std::int64_t theta = std::llround(std::atan2(std::hypot(d.x, d.y), d.z) * cells_per_radian);
  if (theta == 0) return {0, 0};
  const std::int64_t phi = std::llround(std::atan2(d.y, d.x) * cells_per_radian);
  return {theta, (phi + full_turn) % full_turn};
}

/// Where a sample belongs: both samples of a swapped pair have the same `pair`, and one of them
/// has its light and viewer `swapped`.
struct Place {
  std::uint64_t pair;
  std::uint32_t sample;
  bool swapped;
};

std::uint64_t packed(const GridAngles& a, const GridAngles& b) {
  std::uint64_t key = 0;
  for (const std::int64_t angle : {a.theta, a.phi, b.theta, b.phi}) {
    key = key << 16U | static_cast<std::uint64_t>(angle);
  }
  return key;
}

Place exact_place(const GridAngles& wi, const GridAngles& wo, std::uint32_t sample) {
  const std::uint64_t key = packed(wi, wo);
  const std::uint64_t swapped = packed(wo, wi);
  return {std::min(key, swapped), sample, key > swapped};
}

Place isotropic_place(const GridAngles& wi, const GridAngles& wo, std::uint32_t sample) {
  std::int64_t between = 0;
  if (wi.theta != 0 && wo.theta != 0) {
    between = std::abs(wi.phi - wo.phi);
    between = std::min(between, full_turn - between);
  }
  return exact_place({wi.theta, between}, {wo.theta, between}, sample);
}

/// The mean of one channel over some places, NaN if all are holes.
double mean_at(std::span<const Place> places, const std::vector<double>& values) {
  double sum = 0;
  std::size_t count = 0;
  for (const Place& place : places) {
    const double value = values[place.sample];
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return sum / static_cast<double>(count);
}

class Comparison {
 public:
  void add(double f, double swapped) {
    const double size = (std::abs(f) + std::abs(swapped)) / 2;
    if (!(size > 0)) return;  // a hole, or nothing to relate a difference to
    const double relative = (f - swapped) / size;
    sum_ += relative * relative;
    ++count_;
  }
  double rms() const { return count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0; }
  std::size_t count() const { return count_; }

 private:
  double sum_ = 0;
  std::size_t count_ = 0;
};

std::optional<Reciprocity> compare(const SampleTable& table, std::vector<Place> places) {
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::tie(a.pair, a.swapped, a.sample) < std::tie(b.pair, b.swapped, b.sample);
  });
  Comparison comparison;
  Reciprocity result;
  for (auto first = places.begin(); first != places.end();) {
    const auto is_elsewhere = [&](const Place& p) { return p.pair != first->pair; };
    const auto end = std::find_if(first, places.end(), is_elsewhere);
    const auto middle = std::find_if(first, end, [](const Place& p) { return p.swapped; });
    if (middle != first && middle != end) {
      const std::size_t before = comparison.count();
      for (const std::vector<double>& channel : table.values) {
        comparison.add(mean_at({first, middle}, channel), mean_at({middle, end}, channel));
      }
      if (comparison.count() > before) ++result.pairs;
    }
    first = end;
  }
  if (result.pairs < fewest_pairs) return std::nullopt;
  result.rms_relative = comparison.rms();
  return result;
}

}  // namespace

std::optional<Reciprocity> reciprocity_of(const SampleTable& table) {
  std::vector<Place> exact;
  std::vector<Place> isotropic;
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    if (table.mask[i] != MaskReason::none) continue;
    const GridAngles wi = grid_angles(table.wi[i]);
    const GridAngles wo = grid_angles(table.wo[i]);
    exact.push_back(exact_place(wi, wo, i));
    isotropic.push_back(isotropic_place(wi, wo, i));
  }
  if (auto result = compare(table, std::move(exact))) return result;
  auto result = compare(table, std::move(isotropic));
  if (result) result->assumed_isotropy = true;
  return result;
}

}  // namespace gonio::table
