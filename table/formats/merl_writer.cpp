#include "table/formats/merl_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "table/file_error.h"
#include "table/formats/merl.h"
#include "table/formats/merl_grid.h"
#include "table/parallel.h"

namespace gonio::table {

namespace {

constexpr MerlGrid grid{};
constexpr std::size_t channel_count = merl_channels.size();
constexpr double not_measured = -1;

const std::string& place(const SampleTable& table) {
  return table.provenance.path.empty() ? table.name : table.provenance.path;
}

void require_three_channels(const SampleTable& table) {
  if (table.channels.size() == channel_count) return;
  throw FileError(
      fmt::format("{}: {} channel{}, expected the three channels of MERL, red, green and blue: "
                  "choose them with --channels",
                  place(table), table.channels.size(), table.channels.size() == 1 ? "" : "s"));
}

// Samples to bins ---------------------------------------------------------------------------------

bool has_value(const SampleTable& table, std::size_t i) {
  return std::any_of(table.values.begin(), table.values.end(),
                     [i](const std::vector<double>& values) { return !std::isnan(values[i]); });
}

/// At the horizon and below it a grid may hold values that nobody should use, but that are its own.
bool is_kept(const SampleTable& table, std::size_t i, const MerlPlace& place) {
  const MaskReason reason = table.mask[i];
  if (reason != MaskReason::none && !(reason == MaskReason::horizon && place.is_on_node)) {
    return false;
  }
  return has_value(table, i);
}

std::vector<MerlPlace> places_of(const SampleTable& table) {
  std::vector<MerlPlace> places(table.size());
  constexpr std::size_t block = 8192;
  parallel_for((table.size() + block - 1) / block, 0, [&](std::size_t b) {
    const std::size_t end = std::min(table.size(), (b + 1) * block);
    for (std::size_t i = b * block; i < end; ++i) {
      places[i] = merl_place(grid, table.wi[i], table.wo[i]);
    }
  });
  // Without phi_d every bin of the row is right.
  std::vector<std::size_t> found(grid.theta_h_count);
  for (MerlPlace& place : places) {
    if (!place.has_phi_d) place.bin += found[place.theta_h_bin]++ % grid.phi_d_count;
  }
  return places;
}

/// f_r per channel and bin, and how many samples a bin holds.
struct Bins {
  std::array<std::vector<double>, channel_count> sums;
  std::array<std::vector<std::uint32_t>, channel_count> counts;
  std::vector<std::uint32_t> samples;

  Bins() : samples(grid.bins()) {
    for (auto& sum : sums) sum.resize(grid.bins());
    for (auto& count : counts) count.resize(grid.bins());
  }

  void add(std::size_t channel, std::size_t bin, double f_r) {
    double& sum = sums[channel][bin];
    sum = counts[channel][bin]++ == 0 ? f_r : sum + f_r;
  }
};

bool has_weight_of_bin(const SampleTable& table, std::size_t i, const MerlPlace& place) {
  const double weight = merl_weight(grid, place.theta_h_bin, place.theta_d_bin);
  return std::abs(table.weight[i] - weight) <= 1e-9 * weight;
}

void add_sample(const SampleTable& table, std::size_t i, const MerlPlace& place, Bins& bins,
                MerlLoss& loss) {
  ++loss.written;
  ++bins.samples[place.bin];
  for (std::size_t c = 0; c < channel_count; ++c) {
    const double f_r = table.values[c][i];
    if (std::isnan(f_r)) continue;
    if (f_r < 0) ++loss.clamped;
    bins.add(c, place.bin, f_r < 0 ? 0 : f_r);
  }
  if (!place.is_on_node) {
    ++loss.moved;
    loss.largest_move_deg = std::max(loss.largest_move_deg, place.moved * 180 / std::numbers::pi);
  }
  if (place.is_turned) ++loss.turned;
  if (table.has_weight() && !has_weight_of_bin(table, i, place)) loss.lost_weight = true;
}

Bins filled_bins(const SampleTable& table, MerlLoss& loss) {
  const std::vector<MerlPlace> places = places_of(table);
  Bins bins;
  for (const MaskReason reason : {MaskReason::none, MaskReason::horizon}) {
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (table.mask[i] != reason || !is_kept(table, i, places[i])) continue;
      // What was measured is not mixed with what was not.
      if (reason == MaskReason::horizon && bins.samples[places[i].bin] > 0) continue;
      add_sample(table, i, places[i], bins, loss);
    }
  }
  return bins;
}

// Bins to bytes -----------------------------------------------------------------------------------

/// The value that reads as f_r, if there is one, else one next to it.
double value_of(double f_r, double scale) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double value = f_r / scale;
  for (const double near : {value, std::nextafter(value, infinity), std::nextafter(value, 0.0)}) {
    if (near * scale == f_r) return near;
  }
  return value;
}

/// Turns the sums of a channel into the values of the file.
void finish(const SampleTable& table, std::size_t channel, Bins& bins) {
  for (std::size_t bin = 0; bin < grid.bins(); ++bin) {
    const std::uint32_t count = bins.counts[channel][bin];
    double& value = bins.sums[channel][bin];
    value = count == 0 ? not_measured : value_of(value / count, merl_scales[channel]);
    if (std::isfinite(value)) continue;
    throw FileError(
        fmt::format("{}: channel {}: a value is too large for MERL, which multiplies "
                    "by up to 1500: leave it out",
                    place(table), table.channels[channel]));
  }
}

void count_bins(const Bins& bins, MerlLoss& loss) {
  loss.bins = grid.bins();
  for (const std::uint32_t samples : bins.samples) {
    if (samples > 0) ++loss.filled;
    if (samples > 1) loss.merged += samples;
  }
}

template <class Number>
std::string_view bytes_of(const Number* numbers, std::size_t count) {
  return {reinterpret_cast<const char*>(numbers), count * sizeof(Number)};
}

}  // namespace

MerlLoss write_merl(const SampleTable& table, const std::function<void(std::string_view)>& write) {
  require_three_channels(table);
  MerlLoss loss;
  loss.samples = table.size();
  loss.lost_sigma = table.has_sigma();
  if (!std::equal(table.channels.begin(), table.channels.end(), merl_channels.begin())) {
    loss.renamed = table.channels;
  }
  Bins bins = filled_bins(table, loss);
  for (std::size_t i = 0; i < table.size(); ++i) loss.holes += has_value(table, i) ? 0 : 1;
  loss.dropped = loss.samples - loss.holes - loss.written;
  count_bins(bins, loss);
  for (std::size_t c = 0; c < channel_count; ++c) finish(table, c, bins);
  constexpr std::array<std::int32_t, 3> sizes{grid.theta_h_count, grid.theta_d_count,
                                              grid.phi_d_count};
  write(bytes_of(sizes.data(), sizes.size()));
  for (const std::vector<double>& values : bins.sums) write(bytes_of(values.data(), values.size()));
  return loss;
}

std::vector<std::string> describe(const MerlLoss& loss) {
  std::vector<std::string> sentences;
  const auto say = [&](bool is_so, std::string sentence) {
    if (is_so) sentences.push_back(std::move(sentence));
  };
  say(!loss.renamed.empty(),
      fmt::format("the channels {} became R, G and B", fmt::join(loss.renamed, ", ")));
  say(loss.dropped > 0, fmt::format("{} of the {} samples are masked: they are left out",
                                    loss.dropped, loss.samples));
  say(loss.moved > 0,
      fmt::format("{} of the {} samples were moved to their bin's node, by up to {:.3g} deg",
                  loss.moved, loss.samples, loss.largest_move_deg));
  say(loss.merged > 0,
      fmt::format("{} samples share their bin with others: it holds their mean", loss.merged));
  say(loss.turned > 0,
      fmt::format("{} samples were turned about the normal, so that their half vector lies at "
                  "phi = 0: MERL holds isotropic materials only",
                  loss.turned));
  say(loss.clamped > 0,
      fmt::format("{} negative values became 0: in MERL they would mean that nothing was measured",
                  loss.clamped));
  say(loss.samples < loss.bins,
      fmt::format("{} of the {} bins hold a measurement", loss.filled, loss.bins));
  say(loss.lost_sigma, "the standard deviations are left out");
  say(loss.lost_weight,
      "the weights are left out: reading the file gives the solid angles of its bins");
  return sentences;
}

}  // namespace gonio::table
