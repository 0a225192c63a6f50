#include "table/formats/zemax_mask.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>

namespace gonio::table {

namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;
constexpr double horizon_tolerance_deg = 1e-6;

/// The cosine of theta_o of each sample of a block, [azimuth][radial].
std::vector<double> exit_cosines(const ZemaxText& text, double incidence) {
  const double cos_i = std::cos(incidence * radians_per_degree);
  const double sin_i = std::sin(incidence * radians_per_degree);
  std::vector<double> cosines;
  cosines.reserve(text.block_size());
  for (const double azimuth : text.azimuths) {
    const double towards_normal = std::cos(azimuth * radians_per_degree) * sin_i;
    for (const double radial : text.radials) {
      cosines.push_back(std::cos(radial * radians_per_degree) * cos_i +
                        std::sin(radial * radians_per_degree) * towards_normal);
    }
  }
  return cosines;
}

/// One rotation and incidence: what is known of its samples.
struct BlockView {
  const ZemaxText& text;
  std::size_t first;  // sample
  std::span<const double> cosines;
  std::span<MaskReason> mask;

  bool is_zero(std::size_t i) const {
    return std::all_of(text.values.begin(), text.values.end(),
                       [&](const auto& channel) { return channel[first + i] == 0; });
  }
  bool is_above_horizon(std::size_t i) const { return mask[i] != MaskReason::horizon; }
};

void mask_horizon(const BlockView& block, double incidence) {
  const double least = std::sin(horizon_tolerance_deg * radians_per_degree);
  const bool is_wi_horizontal = incidence >= 90 - horizon_tolerance_deg;
  for (std::size_t i = 0; i < block.mask.size(); ++i) {
    if (is_wi_horizontal || block.cosines[i] <= least) block.mask[i] = MaskReason::horizon;
  }
}

/// Zeros beyond the polar angle of the last sample that is not zero. Fewer than three may be one
/// reading, on an azimuth that the file lists as 0 and as 360 deg.
void mask_beyond_last_reading(const BlockView& block) {
  constexpr double same_cosine = 1e-12;
  constexpr std::size_t fewest = 3;
  double last = 2;
  for (std::size_t i = 0; i < block.mask.size(); ++i) {
    if (block.is_above_horizon(i) && !block.is_zero(i)) last = std::min(last, block.cosines[i]);
  }
  std::vector<std::size_t> beyond;
  for (std::size_t i = 0; i < block.mask.size(); ++i) {
    if (block.is_above_horizon(i) && block.cosines[i] < last - same_cosine) beyond.push_back(i);
  }
  if (beyond.size() < fewest) return;
  for (const std::size_t i : beyond) block.mask[i] = MaskReason::padding;
}

/// Zeros that end a row. Instruments stop at another polar angle on the side of the lamp than on
/// the other side, so that rows end where others still have readings.
void mask_row_ends(const BlockView& block) {
  constexpr std::size_t fewest = 2;
  const std::size_t row_size = block.text.radials.size();
  for (std::size_t row = 0; row < block.mask.size(); row += row_size) {
    std::size_t zeros = 0;
    while (zeros < row_size && block.is_zero(row + row_size - 1 - zeros)) ++zeros;
    if (zeros < fewest) continue;
    for (std::size_t i = row + row_size - zeros; i < row + row_size; ++i) {
      if (block.is_above_horizon(i)) block.mask[i] = MaskReason::padding;
    }
  }
}

void clear_masked(const std::vector<MaskReason>& mask, std::vector<double>& values) {
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != MaskReason::none) values[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

std::vector<MaskReason> mask_zemax(ZemaxText& text) {
  const std::size_t size = text.block_size();
  std::vector<MaskReason> mask(text.block_count() * size, MaskReason::none);
  for (std::size_t i = 0; i < text.incidences.size(); ++i) {
    const std::vector<double> cosines = exit_cosines(text, text.incidences[i]);
    for (std::size_t r = 0; r < text.rotations.size(); ++r) {
      const std::size_t first = (r * text.incidences.size() + i) * size;
      const BlockView block{.text = text,
                            .first = first,
                            .cosines = cosines,
                            .mask = std::span(mask).subspan(first, size)};
      mask_horizon(block, text.incidences[i]);
      mask_beyond_last_reading(block);
      mask_row_ends(block);
    }
  }
  for (std::vector<double>& values : text.values) clear_masked(mask, values);
  return mask;
}

}  // namespace gonio::table
