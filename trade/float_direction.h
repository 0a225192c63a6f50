// Directions as a shader receives them: in float.
#pragma once

#include "brdf/direction.h"

namespace gonio::trade {

/// The components rounded to float.
inline brdf::DirectionPair<float> in_float(const brdf::DirectionPair<double>& pair) {
  const auto rounded = [](const brdf::Direction<double>& w) {
    return brdf::Direction<float>{float(w.x), float(w.y), float(w.z)};
  };
  return {rounded(pair.wi), rounded(pair.wo)};
}

/// The components in double as they are.
inline brdf::DirectionPair<double> in_double(const brdf::DirectionPair<float>& pair) {
  const auto as_they_are = [](const brdf::Direction<float>& w) {
    return brdf::Direction<double>{double(w.x), double(w.y), double(w.z)};
  };
  return {as_they_are(pair.wi), as_they_are(pair.wo)};
}

}  // namespace gonio::trade
