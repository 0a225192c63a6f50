// A list of polar angles on the command line.
#pragma once

#include <string_view>
#include <vector>

namespace gonio::app {

/// The angles of "0,45,80" in degrees, each from 0 to less than 90. Throws std::invalid_argument
/// that names the option.
std::vector<double> parse_polar_angles(std::string_view option, std::string_view text);

}  // namespace gonio::app
