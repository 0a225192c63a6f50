#include "apps/gonio/polar_angles.h"

#include <fmt/format.h>

#include <stdexcept>

#include "apps/gonio/command.h"

namespace gonio::app {

std::vector<double> parse_polar_angles(std::string_view option, std::string_view text) {
  std::vector<double> angles;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const auto theta = parse_number(rest.substr(0, comma));
    if (!theta) {
      throw std::invalid_argument(
          fmt::format("{} {}: expected polar angles in degrees, such as 0,45,80", option, text));
    }
    if (!(*theta >= 0 && *theta < 90)) {
      throw std::invalid_argument(fmt::format(
          "{} {}: {} degrees, expected 0 to less than 90, measured from the surface normal", option,
          text, *theta));
    }
    angles.push_back(*theta);
    if (comma == std::string_view::npos) return angles;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace gonio::app
