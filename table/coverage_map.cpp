#include "table/coverage_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gonio::table {
namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;
constexpr double polar_step_deg = 10;
constexpr double azimuth_step_deg = 15;
/// Incidence angles are told apart as describe() does.
constexpr double listed_tolerance_deg = 0.05;
constexpr double binned_tolerance_deg = 7.5;

using Counts = std::array<std::size_t, mask_reason_count>;
using CountGrid =
    std::array<std::array<Counts, CoverageMap::azimuth_cells>, CoverageMap::polar_cells>;

double polar_angle_deg(const brdf::Direction<double>& d) {
  return std::atan2(std::hypot(d.x, d.y), d.z) * degrees_per_radian;
}

/// 0 to 180; of the viewer itself where the light is at the pole.
double azimuth_between_deg(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo) {
  if (std::hypot(wi.x, wi.y) < 1e-9) {
    return std::abs(std::atan2(wo.y, wo.x)) * degrees_per_radian;
  }
  return std::abs(std::atan2(wi.x * wo.y - wi.y * wo.x, wi.x * wo.x + wi.y * wo.y)) *
         degrees_per_radian;
}

void count(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo, MaskReason reason,
           CountGrid& grid) {
  const double theta_deg = polar_angle_deg(wo);
  const auto row = std::min(static_cast<std::size_t>((theta_deg + 1e-6) / polar_step_deg),
                            CoverageMap::polar_cells - 1);
  const auto add = [&](std::size_t column) {
    ++grid[row][column][static_cast<std::size_t>(reason)];
  };
  if (theta_deg < 1e-6) {
    for (std::size_t column = 0; column < CoverageMap::azimuth_cells; ++column) add(column);
  } else {
    add(static_cast<std::size_t>(std::lround(azimuth_between_deg(wi, wo) / azimuth_step_deg)));
  }
}

CoverageCell cell_of(const Counts& counts) {
  if (counts.front() > 0) return MaskReason::none;
  const auto most = std::max_element(counts.begin(), counts.end());
  if (*most == 0) return std::nullopt;
  return static_cast<MaskReason>(most - counts.begin());
}

std::vector<std::size_t> spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t taken = std::min(count, most);
  for (std::size_t k = 0; k < taken; ++k) {
    chosen.push_back(taken == 1 ? 0 : k * (count - 1) / (taken - 1));
  }
  return chosen;
}

}  // namespace

std::vector<CoverageMap> coverage_maps(const SampleTable& table, const Description& description,
                                       std::size_t most) {
  const double tolerance_deg =
      description.incidence_binned ? binned_tolerance_deg : listed_tolerance_deg;
  std::vector<CoverageMap> maps;
  for (const std::size_t k : spread(description.incidences.size(), most)) {
    maps.push_back({description.incidences[k].theta_deg, {}});
  }
  std::vector<CountGrid> grids(maps.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const brdf::Direction<double> wi = table.wi[i];
    const brdf::Direction<double> wo = table.wo[i];
    if (wi.z < -1e-8 || wo.z < -1e-8) continue;
    const double theta_i_deg = polar_angle_deg(wi);
    for (std::size_t m = 0; m < maps.size(); ++m) {
      const double distance_deg = theta_i_deg - maps[m].theta_i_deg;
      if (distance_deg < -tolerance_deg || distance_deg >= tolerance_deg) continue;
      count(wi, wo, table.mask[i], grids[m]);
    }
  }
  for (std::size_t m = 0; m < maps.size(); ++m) {
    for (std::size_t row = 0; row < CoverageMap::polar_cells; ++row) {
      std::transform(grids[m][row].begin(), grids[m][row].end(), maps[m].cells[row].begin(),
                     cell_of);
    }
  }
  return maps;
}

}  // namespace gonio::table
