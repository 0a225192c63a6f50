// What a parameter of a term is: the name users write, its unit, bounds, meaning and source.
#pragma once

#include <string_view>

namespace gonio::brdf {

/// How a search walks along a parameter: `logarithmic` for scales such as a roughness,
/// `logarithmic_from_one` (by ln(1 + p)) for exponents, which may be 0, `quadratic` where only the
/// square of the parameter matters, so that nothing changes near 0 to first order, and `periodic`
/// for an angle whose bounds are one period apart, so that both ends say the same.
enum class Scale { linear, logarithmic, logarithmic_from_one, quadratic, periodic };

struct Parameter {
  std::string_view name;
  std::string_view unit;
  /// Closed bounds within which the term may be evaluated; infinity where there is none.
  double lower;
  double upper;
  /// Where a search for start values looks; unused for amplitudes, which are solved for.
  double search_lower;
  double search_upper;
  Scale scale;
  std::string_view meaning;
  std::string_view source;
};

}  // namespace gonio::brdf
