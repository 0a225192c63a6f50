// The known name that a mistyped one was probably meant to be, for messages.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace gonio::brdf {

/// The entry of `known` at the smallest distance from `given`, the first of several; nothing if it
/// is too far off to be meant: more than a third of the given letters (at least 1) away, or as far
/// as no common letter at all. Upper and lower case count as the same.
///
/// The distance is Damerau and Levenshtein's, restricted to edits that do not overlap: how many
/// letters to insert, delete, replace, or exchange with their neighbour. The result points into
/// `known`.
std::optional<std::string_view> nearest_name(std::string_view given,
                                             std::span<const std::string> known);

}  // namespace gonio::brdf
