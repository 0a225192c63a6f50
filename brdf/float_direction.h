// Directions as a shader receives them, in float, and back.
//
// g++ 12 at -O2 has been seen to drop the pair of conversions in a loop that replaces a vector's
// elements by in_double(in_float(element)): keep the floats in a vector of their own.
#pragma once

#include "brdf/direction.h"

namespace gonio::brdf {

/// The components rounded to float.
inline Direction<float> in_float(const Direction<double>& w) {
  return {static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)};
}

/// The components as they are.
inline Direction<double> in_double(const Direction<float>& w) { return {w.x, w.y, w.z}; }

inline DirectionPair<float> in_float(const DirectionPair<double>& pair) {
  return {in_float(pair.wi), in_float(pair.wo)};
}

inline DirectionPair<double> in_double(const DirectionPair<float>& pair) {
  return {in_double(pair.wi), in_double(pair.wo)};
}

}  // namespace gonio::brdf
