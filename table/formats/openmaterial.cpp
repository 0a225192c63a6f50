#include "table/formats/openmaterial.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "table/formats/openmaterial_contents.h"
#include "table/formats/openmaterial_grid.h"

namespace gonio::table {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Provenance provenance_of(const std::string& path) {
  return {.path = path,
          .format = "OpenMATERIAL 3D",
          .sha256 = {},
          .quantity = Quantity::brdf,
          .angles = AngleUnit::radians};
}

// Samples ------------------------------------------------------------------------------------

bool is_horizontal(double theta) {
  constexpr double largest_of_the_standard = 1.570796;  // pi/2, rounded down
  return theta >= largest_of_the_standard;
}

MaskReason mask_of(const OpenMaterialContents& contents, std::size_t direction) {
  const RelativeAngles& a = contents.angles[direction];
  if (is_horizontal(a.theta_i) || is_horizontal(a.theta_o)) return MaskReason::horizon;
  const bool is_hole =
      std::all_of(contents.values.begin(), contents.values.end(),
                  [&](const auto& values) { return std::isnan(values[direction]); });
  return is_hole ? MaskReason::hole : MaskReason::none;
}

std::vector<std::size_t> all_of(std::size_t count) {
  std::vector<std::size_t> samples(count);
  std::iota(samples.begin(), samples.end(), std::size_t{0});
  return samples;
}

// The grid -----------------------------------------------------------------------------------

/// Channels with rows for the same directions.
struct ChannelGroup {
  NestedGrid grid;
  std::vector<std::size_t> channels;
};

struct Grid {
  std::vector<std::vector<double>> values;
  std::vector<ChannelGroup> groups;

  void f_r(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
           std::span<double> f_r) const {
    std::fill(f_r.begin(), f_r.end(), nan);
    if (!brdf::above_horizon(wi, wo)) return;
    for (const ChannelGroup& group : groups) {
      const GridNodes found = group.grid.nodes_for(wi, wo);
      if (found.count == 0) continue;
      for (const std::size_t channel : group.channels) f_r[channel] = sum(found, values[channel]);
    }
  }

 private:
  static double sum(const GridNodes& found, const std::vector<double>& values) {
    double total = 0;
    for (std::size_t k = 0; k < found.count; ++k) {
      const auto [sample, share] = found.nodes[k];
      if (share > 0) total += share * values[sample];
    }
    return total;
  }
};

std::vector<std::size_t> positions_of(const std::vector<bool>& flags) {
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i]) positions.push_back(i);
  }
  return positions;
}

std::vector<ChannelGroup> channel_groups(const OpenMaterialContents& contents) {
  std::vector<ChannelGroup> groups;
  for (std::size_t c = 0; c < contents.channels.size(); ++c) {
    // Only a neighbour is compared, so that the time does not grow with the square.
    if (c > 0 && contents.has_row[c] == contents.has_row[c - 1]) {
      groups.back().channels.push_back(c);
      continue;
    }
    groups.push_back({NestedGrid(contents.angles, positions_of(contents.has_row[c])), {c}});
  }
  return groups;
}

}  // namespace

bool is_openmaterial(std::string_view content) {
  constexpr std::size_t judged = std::size_t{1} << 16;
  std::string_view start = content.substr(0, judged);
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || start[first] != '{') return false;
  const auto has = [&](std::string_view text) {
    return start.find(text) != std::string_view::npos;
  };
  return has("\"lookupTable\"") && (has("\"openMaterial3dVersion\"") || has("\"brdf\"")) &&
         !has("\"gonio-material\"");
}

SampleTable read_openmaterial(std::string_view content, const std::string& path,
                              const ReadOptions& /*options*/) {
  OpenMaterialContents contents = read_openmaterial_contents(content, path);
  const std::size_t count = contents.angles.size();
  SampleTable table;
  table.name = std::move(contents.name);
  table.channels = std::move(contents.channels);
  table.wi.resize(count);
  table.wo.resize(count);
  table.mask.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const RelativeAngles& a = contents.angles[i];
    table.wi.set(i, brdf::direction_from_radians(a.theta_i, 0));
    table.wo.set(i, brdf::direction_from_radians(a.theta_o, a.phi));
    table.mask[i] = mask_of(contents, i);
  }
  table.weight = NestedGrid(contents.angles, all_of(count)).solid_angles(count);
  table.weight_is_solid_angle = !table.weight.empty();
  table.notes = std::move(contents.notes);
  if (table.weight.empty()) {
    table.notes.emplace_back("the directions form no grid: the samples have no weights");
  }
  table.values = std::move(contents.values);
  table.provenance = provenance_of(path);
  table.takes_isotropy = true;
  return table;
}

GriddedTable read_openmaterial_grid(std::string_view content, const std::string& path) {
  OpenMaterialContents contents = read_openmaterial_contents(content, path);
  const auto grid = std::make_shared<Grid>();
  grid->groups = channel_groups(contents);
  grid->values = std::move(contents.values);
  return {.name = std::move(contents.name),
          .channels = std::move(contents.channels),
          .f_r = [grid](const brdf::Direction<double>& wi, const brdf::Direction<double>& wo,
                        std::span<double> f_r) { grid->f_r(wi, wo, f_r); },
          .notes = std::move(contents.notes),
          .provenance = provenance_of(path)};
}

}  // namespace gonio::table
