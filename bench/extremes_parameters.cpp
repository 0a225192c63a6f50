#include "bench/extremes_parameters.h"

#include <algorithm>
#include <cmath>

namespace gonio::bench {
namespace {

using brdf::Parameter;
using brdf::Scale;

double draw_inside(RandomSource& random, const Parameter& p) {
  switch (p.scale) {
    case Scale::logarithmic:
      return random.magnitude(p.lower, p.upper);
    case Scale::logarithmic_from_one:
      return std::expm1(random.uniform(std::log1p(p.lower), std::log1p(p.upper)));
    case Scale::linear:
    case Scale::quadratic:
    case Scale::periodic:
      break;
  }
  return random.uniform(p.lower, p.upper);
}

/// The two exponents or roughnesses of an anisotropic lobe.
bool is_pair(const Parameter& first, const Parameter& second) {
  return first.scale == second.scale && first.scale != Scale::linear &&
         first.scale != Scale::periodic;
}

}  // namespace

double draw_shape_parameter(RandomSource& random, const Parameter& p) {
  const auto step = [&] { return random.magnitude(1e-16, nearest_to_bound); };
  switch (random.index(8)) {
    case 0:
      return p.lower;
    case 1:
      return p.upper;
    case 2:
      return std::min(p.lower + step(), p.upper);
    case 3:
      return std::max(p.upper - step(), p.lower);
    default:
      return std::clamp(draw_inside(random, p), p.lower, p.upper);
  }
}

void draw_shape(RandomSource& random, std::span<const Parameter> parameters,
                std::span<double> shape) {
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    shape[k] = draw_shape_parameter(random, parameters[k]);
  }
  if (shape.size() >= 2 && is_pair(parameters[0], parameters[1]) && random.index(4) == 0) {
    const double ratio = random.coin() ? 1000 : 0.001;
    shape[1] = std::clamp(shape[0] * ratio, parameters[1].lower, parameters[1].upper);
  }
}

void draw_amplitudes(RandomSource& random, std::span<const Parameter> parameters,
                     std::span<double> amplitudes) {
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const Parameter& p = parameters[k];
    if (std::isinf(p.upper)) {
      amplitudes[k] = random.uniform(0.01, 1);
      continue;
    }
    const double inside = random.uniform(p.lower, p.upper);
    amplitudes[k] = random.coin() ? inside : (random.coin() ? p.lower : p.upper);
  }
}

}  // namespace gonio::bench
