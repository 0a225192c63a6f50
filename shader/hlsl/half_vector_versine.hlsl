// 1 minus the cosine between the normal and the half vector.
#ifndef GONIO_HALF_VECTOR_VERSINE
#define GONIO_HALF_VECTOR_VERSINE

#include "slope.hlsl"

// 1 - n.h of the half vector, left unnormalised: (n.h)^-2 = 1 + q, q the square of the slope, so it
// is q / (1 + q + sqrt(1 + q)), which cancels nothing.
float gonio_half_vector_versine(float3 h) {
  float2 slope = gonio_slope(h);
  float q = slope.x * slope.x + slope.y * slope.y;
  return q / (1.0 + q + sqrt(1.0 + q));
}

#endif
