#include "table/selection.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "table/channel_choice.h"
#include "table/file_error.h"

namespace gonio::table {
namespace {

/// Calls f(array) for every array of the table that has an element per sample.
template <class F>
void for_each_array(SampleTable& table, const F& f) {
  for (DirectionArray* directions : {&table.wi, &table.wo}) {
    f(directions->x);
    f(directions->y);
    f(directions->z);
  }
  for (std::vector<double>& values : table.values) f(values);
  for (std::vector<double>& sigmas : table.sigma) f(sigmas);
  f(table.weight);
  f(table.angle_text);
  f(table.mask);
}

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// Puts the channels of `table` into the order of `channels`.
void order_channels(SampleTable& table, const SampleTable& first) {
  if (table.channels == first.channels) return;
  if (!std::is_permutation(table.channels.begin(), table.channels.end(), first.channels.begin(),
                           first.channels.end())) {
    throw FileError(fmt::format(
        "{}: found the channels {}, expected {} as in {}: choose common ones with --channels",
        table.provenance.path, fmt::join(table.channels, ", "), fmt::join(first.channels, ", "),
        first.provenance.path));
  }
  std::vector<std::size_t> order;
  for (const std::string& channel : first.channels) {
    const auto found = std::find(table.channels.begin(), table.channels.end(), channel);
    order.push_back(static_cast<std::size_t>(found - table.channels.begin()));
  }
  keep_channels(table, order);
}

void require_alike(const SampleTable& table, const SampleTable& first, bool of_table, bool of_first,
                   std::string_view what) {
  if (of_table == of_first) return;
  const SampleTable& with = of_table ? table : first;
  const SampleTable& without = of_table ? first : table;
  throw FileError(
      fmt::format("{}: found {}, which {} has not, so that their samples would count unequally: "
                  "convert one of them (gonio table convert --drop-{})",
                  with.provenance.path, what, without.provenance.path, what));
}

void append_samples(SampleTable& to, SampleTable& from) {
  for (const auto part : {&SampleTable::wi, &SampleTable::wo}) {
    append((to.*part).x, (from.*part).x);
    append((to.*part).y, (from.*part).y);
    append((to.*part).z, (from.*part).z);
  }
  for (std::size_t c = 0; c < to.values.size(); ++c) append(to.values[c], from.values[c]);
  for (std::size_t c = 0; c < to.sigma.size(); ++c) append(to.sigma[c], from.sigma[c]);
  append(to.weight, from.weight);
  append(to.angle_text, from.angle_text);
  append(to.mask, from.mask);
}

}  // namespace

void keep_samples(SampleTable& table, const std::function<bool(std::size_t)>& is_kept) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (is_kept(i)) kept.push_back(i);
  }
  for_each_array(table, [&](auto& array) {
    if (array.empty()) return;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      if (kept[k] != k) array[k] = std::move(array[kept[k]]);
    }
    array.resize(kept.size());
    array.shrink_to_fit();
  });
}

void crop(SampleTable& table, double max_theta_deg) {
  const double least_cos = std::cos(std::min(max_theta_deg + 1e-6, 90.0) * std::numbers::pi / 180);
  const bool is_whole_hemisphere = max_theta_deg >= 90;
  keep_samples(table, [&](std::size_t i) {
    return is_whole_hemisphere || (table.wi.z[i] >= least_cos && table.wo.z[i] >= least_cos);
  });
}

SampleTable merge(std::span<SampleTable> tables) {
  SampleTable& first = tables.front();
  bool keeps_text = !first.angle_text.empty();
  for (SampleTable& table : tables.subspan(1)) {
    order_channels(table, first);
    require_alike(table, first, table.has_sigma(), first.has_sigma(), "sigma");
    require_alike(table, first, table.has_weight(), first.has_weight(), "weight");
    keeps_text = keeps_text && !table.angle_text.empty() &&
                 table.provenance.angles == first.provenance.angles;
  }
  SampleTable merged = std::move(first);
  for (SampleTable& table : tables.subspan(1)) {
    merged.weight_is_solid_angle = merged.weight_is_solid_angle && table.weight_is_solid_angle;
    merged.takes_isotropy = merged.takes_isotropy && table.takes_isotropy;
    append_samples(merged, table);
    if (merged.name.empty()) merged.name = table.name;
  }
  if (!keeps_text) merged.angle_text.clear();
  return merged;
}

}  // namespace gonio::table
