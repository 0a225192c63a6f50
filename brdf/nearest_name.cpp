#include "brdf/nearest_name.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace gonio::brdf {
namespace {

/// ASCII only and whatever the locale: the names are.
char lower_case(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

bool same_letter(char a, char b) { return lower_case(a) == lower_case(b); }

/// Row i of the usual table holds the distances of the first i letters of `a` from the beginnings
/// of `b`; three rows are enough.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_above(b.size() + 1);
  std::vector<std::size_t> above(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(two_above, above);
    std::swap(above, row);
    row[0] = i;
    for (std::size_t k = 1; k <= b.size(); ++k) {
      const std::size_t replaced = above[k - 1] + (same_letter(a[i - 1], b[k - 1]) ? 0 : 1);
      row[k] = std::min({above[k] + 1, row[k - 1] + 1, replaced});
      const bool exchanged =
          i > 1 && k > 1 && same_letter(a[i - 1], b[k - 2]) && same_letter(a[i - 2], b[k - 1]);
      if (exchanged) row[k] = std::min(row[k], two_above[k - 2] + 1);
    }
  }
  return row[b.size()];
}

bool is_meant(std::size_t distance, std::string_view given, std::string_view name) {
  const std::size_t allowed = std::max<std::size_t>(1, given.size() / 3);
  return distance <= allowed && distance < std::max(given.size(), name.size());
}

}  // namespace

std::optional<std::string_view> nearest_name(std::string_view given,
                                             std::span<const std::string> known) {
  std::optional<std::string_view> nearest;
  std::size_t smallest = 0;
  for (const std::string& name : known) {
    const std::size_t away = distance(given, name);
    if (!is_meant(away, given, name) || (nearest && away >= smallest)) continue;
    nearest = name;
    smallest = away;
  }
  return nearest;
}

}  // namespace gonio::brdf
