#include "table/formats/columns.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "table/channel_names.h"
#include "table/file_error.h"
#include "table/formats/text_lines.h"

namespace gonio::table {

namespace {

constexpr std::string_view sigma_prefix = "sigma_";

void check_names(const std::vector<std::string>& names, const std::string& place) {
  std::map<std::string_view, std::size_t> first_of;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) {
      throw FileError(
          fmt::format("{}: column {} has no name: give every column one", place, i + 1));
    }
    if (names[i].find('"') != std::string::npos) {
      throw FileError(fmt::format("{}: column name {} is quoted: write names without quotes", place,
                                  quoted(names[i])));
    }
    const auto [entry, is_new] = first_of.emplace(names[i], i);
    if (!is_new) {
      throw FileError(fmt::format("{}: columns {} and {} are both named {}: rename or remove one",
                                  place, entry->second + 1, i + 1, quoted(names[i])));
    }
  }
}

std::size_t angle_column(const std::vector<std::string>& names, const char* angle,
                         const std::string& place) {
  const auto found = std::find(names.begin(), names.end(), angle);
  if (found == names.end()) {
    const bool semicolons = names.front().find(';') != std::string::npos;
    throw FileError(
        fmt::format("{}: no column '{}' among the column names ({} found, the first is {}): {}",
                    place, angle, names.size(), quoted(names.front()),
                    semicolons ? "separate columns by commas, not semicolons"
                               : "name the columns theta_i, phi_i, theta_o, phi_o, then channels"));
  }
  return static_cast<std::size_t>(found - names.begin());
}

/// Fills columns.sigmas from pairs of channel name and position.
void arrange_sigmas(const std::map<std::string, std::size_t>& sigmas, const std::string& place,
                    Columns& columns) {
  if (sigmas.empty()) return;
  for (const auto& [channel, position] : sigmas) {
    if (std::find(columns.channels.begin(), columns.channels.end(), channel) ==
        columns.channels.end()) {
      throw FileError(fmt::format("{}: column {} is the sigma of no channel: expected a column {}",
                                  place, quoted(columns.names[position]), quoted(channel)));
    }
  }
  for (const std::string& channel : columns.channels) {
    const auto found = sigmas.find(channel);
    if (found == sigmas.end()) {
      throw FileError(
          fmt::format("{}: channel {} has no column {}: give sigma for all channels or for none",
                      place, quoted(channel), quoted(std::string(sigma_prefix) + channel)));
    }
    columns.sigmas.push_back(found->second);
  }
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

}  // namespace

std::optional<AngleUnit> angle_unit_named(std::string_view text) {
  const std::string word = lower(text);
  if (word.starts_with("deg")) return AngleUnit::degrees;
  if (word.starts_with("rad")) return AngleUnit::radians;
  return std::nullopt;
}

NameAndUnit without_unit(std::string_view name) {
  if (const std::size_t bracket = name.find_first_of("(["); bracket != std::string_view::npos) {
    const auto unit = angle_unit_named(name.substr(bracket + 1));
    if (unit) return {std::string(trimmed(name.substr(0, bracket))), unit};
  }
  if (const std::size_t last = name.rfind('_'); last != std::string_view::npos) {
    const std::string suffix = lower(name.substr(last + 1));
    if (suffix == "deg" || suffix == "rad") {
      return {std::string(name.substr(0, last)), angle_unit_named(suffix)};
    }
  }
  return {std::string(name), std::nullopt};
}

std::string canonical_column_name(const std::string& written) {
  constexpr std::array<std::string_view, 4> incident{"i", "in", "l", "light"};
  constexpr std::array<std::string_view, 7> exitant{"o", "out", "s", "r", "v", "e", "viewer"};
  const std::string name = lower(written);
  for (const std::string_view angle : {"theta", "phi"}) {
    if (!name.starts_with(angle)) continue;
    std::string_view side = std::string_view(name).substr(angle.size());
    if (side.starts_with('_')) side.remove_prefix(1);
    const auto is_side = [&](const auto& sides) {
      return std::find(sides.begin(), sides.end(), side) != sides.end();
    };
    if (is_side(incident)) return std::string(angle) + "_i";
    if (is_side(exitant)) return std::string(angle) + "_o";
  }
  return written;
}

Columns arrange_columns(const std::vector<std::string>& names, const std::string& place,
                        ChannelNeed need) {
  if (names.empty()) throw FileError(fmt::format("{}: no column names", place));
  Columns columns;
  columns.names = names;
  for (std::size_t a = 0; a < angle_names.size(); ++a) {
    columns.angles[a] = angle_column(names, angle_names[a], place);
  }
  check_names(names, place);
  std::map<std::string, std::size_t> sigmas;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::find(columns.angles.begin(), columns.angles.end(), i) != columns.angles.end()) {
      continue;
    }
    if (names[i] == "weight") {
      columns.weight = i;
    } else if (names[i].starts_with(sigma_prefix)) {
      sigmas.emplace(names[i].substr(sigma_prefix.size()), i);
    } else {
      columns.channels.push_back(names[i]);
      columns.values.push_back(i);
    }
  }
  if (columns.channels.empty() && need == ChannelNeed::some) {
    throw FileError(fmt::format(
        "{}: no channel: add a column of values beside the angles, named as you like", place));
  }
  if (need == ChannelNeed::some) {
    if (const auto problem = channel_names_problem(columns.channels)) {
      throw FileError(fmt::format("{}: {}: rename or remove one", place, *problem));
    }
  }
  arrange_sigmas(sigmas, place, columns);
  return columns;
}

}  // namespace gonio::table
