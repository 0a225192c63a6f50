// What the solver and the search walk along in place of a parameter p: p itself, ln p, ln(1 + p) or
// p^2.
#pragma once

#include <algorithm>
#include <cmath>

#include "brdf/parameter.h"

namespace gonio::fit {

/// True where equal steps of the variable are (nearly) equal factors of the parameter.
inline bool is_logarithmic(brdf::Scale scale) {
  return scale == brdf::Scale::logarithmic || scale == brdf::Scale::logarithmic_from_one;
}

/// What the solver takes for 0 on a quadratic scale: its square is lost beside anything, but the
/// derivative by the parameter is not 0 yet, and that by the square is found.
inline constexpr double least_root = 1e-7;

/// The variable for a parameter.
inline double to_variable(brdf::Scale scale, double parameter) {
  if (scale == brdf::Scale::logarithmic) return std::log(parameter);
  if (scale == brdf::Scale::logarithmic_from_one) return std::log1p(parameter);
  if (scale == brdf::Scale::quadratic) return parameter * parameter;
  return parameter;
}

/// The parameter for a variable.
inline double from_variable(brdf::Scale scale, double variable) {
  if (scale == brdf::Scale::logarithmic) return std::exp(variable);
  if (scale == brdf::Scale::logarithmic_from_one) return std::expm1(variable);
  if (scale == brdf::Scale::quadratic) return std::sqrt(std::max(variable, 0.0));
  return variable;
}

/// d parameter / d variable.
inline double parameter_slope(brdf::Scale scale, double parameter) {
  if (scale == brdf::Scale::logarithmic) return parameter;
  if (scale == brdf::Scale::logarithmic_from_one) return 1 + parameter;
  if (scale == brdf::Scale::quadratic) return 1 / (2 * std::max(parameter, least_root));
  return 1;
}

/// The parameter at the share `t` of the way through a range.
inline double parameter_between(brdf::Scale scale, double lower, double upper, double t) {
  const double from = to_variable(scale, lower);
  const double to = to_variable(scale, upper);
  return std::clamp(from_variable(scale, from + t * (to - from)), lower, upper);
}

}  // namespace gonio::fit
