// What a lobe's width and amplitude may be, on the command line and in a CSV.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "apps/gonio/convert.h"
#include "material/phong_conversion.h"

namespace gonio::app {

bool is_phong(std::string_view term) { return amplitude_name(term) == "ks"; }

std::string_view width_name(std::string_view term) {
  return material::shape_parameter(term).name == "alpha" ? "alpha" : "exponent";
}

std::string_view amplitude_name(std::string_view term) {
  return material::amplitude_parameter(term).name;
}

double checked_width(std::string_view term, double value) {
  const brdf::Parameter& parameter = material::shape_parameter(term);
  const bool is_exponent = width_name(term) == "exponent";
  if (value >= parameter.lower && value <= parameter.upper && !(is_exponent && value == 0)) {
    return value;
  }
  throw std::invalid_argument(is_exponent
                                  ? fmt::format("the exponent is {:g}, expected more than 0 and up "
                                                "to {:g}; at 0 there is no highlight",
                                                value, parameter.upper)
                                  : fmt::format("alpha is {:g}, expected {:g} to {:g}", value,
                                                parameter.lower, parameter.upper));
}

double checked_amplitude(std::string_view term, double value) {
  // Beyond it nothing of a picture is left, and its squares soon leave the numbers.
  constexpr double largest = 1e6;
  const brdf::Parameter& parameter = material::amplitude_parameter(term);
  const double upper = std::min(parameter.upper, largest);
  if (value >= 0 && value <= upper) return value;
  throw std::invalid_argument(
      fmt::format("{} is {:g}, expected 0 to {:g}", parameter.name, value, upper));
}

double default_amplitude(std::string_view term) {
  // Of ashikhmin-shirley, whose Rs = 1 is a mirror without colour: glass, nearly.
  return amplitude_name(term) == "Rs" ? 0.05 : 1;
}

std::string default_target(std::string_view term) {
  return is_phong(term) ? "ward" : "blinn-phong";
}

}  // namespace gonio::app
