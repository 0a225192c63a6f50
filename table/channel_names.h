// What a channel may be called, so that its name can head a column of a table.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace gonio::table {

/// What is wrong with these names together, in one sentence, or nothing: there has to be one at
/// least, none may be empty, stand twice or mean the wavelength of another (550nm, 550.0nm), hold a
/// comma, a quote or a control character, begin or end with a blank, or be the name of a column
/// that is no channel (theta_i, weight, sigma_R).
std::optional<std::string> channel_names_problem(std::span<const std::string> names);

}  // namespace gonio::table
