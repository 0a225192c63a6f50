#include "table/channel_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "table/channel_wavelength.h"
#include "table/formats/columns.h"

namespace gonio::table {
namespace {

bool can_head_a_column(std::string_view name) {
  if (name.empty() || name.front() == ' ' || name.back() == ' ') return false;
  return std::none_of(name.begin(), name.end(), [](char c) {
    return c == ',' || c == '"' || c == '\x7f' || (c >= '\0' && c < ' ');
  });
}

bool names_another_column(std::string_view name) {
  return name == "weight" || name.starts_with("sigma_") ||
         std::find(angle_names.begin(), angle_names.end(), name) != angle_names.end();
}

/// Two names of one wavelength, such as 550nm and 550.0 nm.
std::optional<std::string> repeated_wavelength(std::span<const std::string> names) {
  constexpr double rounding = 1e-9;  // relative
  std::vector<std::pair<double, std::string_view>> wavelengths;
  for (const std::string& name : names) {
    const auto wavelength = wavelength_of_channel(name);
    if (wavelength && !is_rgb_channel(name)) wavelengths.emplace_back(*wavelength, name);
  }
  std::sort(wavelengths.begin(), wavelengths.end());
  for (std::size_t k = 1; k < wavelengths.size(); ++k) {
    const auto& [shorter, first] = wavelengths[k - 1];
    const auto& [longer, second] = wavelengths[k];
    if (longer - shorter > rounding * longer) continue;
    return fmt::format(
        "the channels '{}' and '{}' are of one wavelength, expected each wavelength once", first,
        second);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> channel_names_problem(std::span<const std::string> names) {
  if (names.empty()) return "found no channel, expected one at least";
  std::unordered_set<std::string_view> seen;
  for (const std::string& name : names) {
    if (!can_head_a_column(name)) {
      return fmt::format(
          "the channel name '{}' cannot head a column of a table, expected a name without commas, "
          "quotes, control characters and outer blanks",
          name);
    }
    if (names_another_column(name)) {
      return fmt::format(
          "the channel name '{}' is that of a column that is no channel, expected another name",
          name);
    }
    if (!seen.insert(name).second) {
      return fmt::format("the channel '{}' stands twice, expected each name once", name);
    }
  }
  return repeated_wavelength(names);
}

}  // namespace gonio::table
