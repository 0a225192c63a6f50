#include "table/channel_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_set>

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
  return std::nullopt;
}

}  // namespace gonio::table
