#include "table/channel_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "table/channel_wavelength.h"
#include "table/formats/text_lines.h"

namespace gonio::table {
namespace {

constexpr double same_wavelength_nm = 0.5;
constexpr std::size_t most_listed = 12;

/// Of a name such as 550nm; R, G and B are names here, no wavelengths.
std::optional<double> wavelength_nm(std::string_view name) {
  if (is_rgb_channel(name)) return std::nullopt;
  const auto metres = wavelength_of_channel(name);
  return metres ? std::optional(*metres * 1e9) : std::nullopt;
}

std::optional<std::size_t> position_of(std::span<const std::string> channels,
                                       std::string_view name) {
  const auto found = std::find(channels.begin(), channels.end(), name);
  if (found == channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - channels.begin());
}

[[noreturn]] void refuse(std::span<const std::string> channels, std::string_view part) {
  const auto listed = channels.first(std::min(channels.size(), most_listed));
  throw std::invalid_argument(fmt::format(
      "channels {}: the table has none such, but {}{}: name channels, ranges in the table's order "
      "such as {}..{}, or wavelengths such as 550nm or 500nm..600nm",
      part, fmt::join(listed, ", "),
      listed.size() < channels.size() ? fmt::format(" and {} more", channels.size() - listed.size())
                                      : "",
      channels.front(), channels.back()));
}

void add(std::vector<std::size_t>& chosen, std::size_t channel) {
  if (std::find(chosen.begin(), chosen.end(), channel) == chosen.end()) chosen.push_back(channel);
}

void add_wavelengths(std::span<const std::string> channels, double lower, double upper,
                     std::vector<std::size_t>& chosen) {
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto wavelength = wavelength_nm(channels[c]);
    if (wavelength && *wavelength >= lower && *wavelength <= upper) add(chosen, c);
  }
}

void add_range(std::span<const std::string> channels, std::string_view from, std::string_view to,
               std::vector<std::size_t>& chosen) {
  const auto first = position_of(channels, from);
  const auto last = position_of(channels, to);
  if (first && last) {
    for (std::size_t c = *first; c <= *last; ++c) add(chosen, c);
    return;
  }
  const auto lower = wavelength_nm(from);
  const auto upper = wavelength_nm(to);
  if (lower && upper) add_wavelengths(channels, *lower - 1e-6, *upper + 1e-6, chosen);
}

void add_part(std::span<const std::string> channels, std::string_view part,
              std::vector<std::size_t>& chosen) {
  if (const auto channel = position_of(channels, part)) return add(chosen, *channel);
  if (const std::size_t dots = part.find(".."); dots != std::string_view::npos) {
    return add_range(channels, trimmed(part.substr(0, dots)), trimmed(part.substr(dots + 2)),
                     chosen);
  }
  if (const auto wavelength = wavelength_nm(part)) {
    add_wavelengths(channels, *wavelength - same_wavelength_nm, *wavelength + same_wavelength_nm,
                    chosen);
  }
}

/// The elements at `kept`, moved.
template <class T>
std::vector<T> picked(std::vector<T>& all, std::span<const std::size_t> kept) {
  std::vector<T> result;
  for (const std::size_t i : kept) result.push_back(std::move(all[i]));
  return result;
}

}  // namespace

std::vector<std::size_t> chosen_channels(std::span<const std::string> channels,
                                         std::string_view choice) {
  std::vector<std::size_t> chosen;
  while (true) {
    const std::size_t comma = choice.find(',');
    const std::string_view part = trimmed(choice.substr(0, comma));
    std::vector<std::size_t> of_part;
    add_part(channels, part, of_part);
    if (of_part.empty()) refuse(channels, part);
    for (const std::size_t channel : of_part) add(chosen, channel);
    if (comma == std::string_view::npos) return chosen;
    choice.remove_prefix(comma + 1);
  }
}

void keep_channels(SampleTable& table, std::span<const std::size_t> kept) {
  table.channels = picked(table.channels, kept);
  table.values = picked(table.values, kept);
  if (table.has_sigma()) table.sigma = picked(table.sigma, kept);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool is_hole = std::all_of(table.values.begin(), table.values.end(),
                                     [&](const auto& values) { return std::isnan(values[i]); });
    if (is_hole && table.mask[i] == MaskReason::none) table.mask[i] = MaskReason::hole;
  }
}

}  // namespace gonio::table
