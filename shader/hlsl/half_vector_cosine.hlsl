// The cosine between the normal and the half vector, as its logarithm: the power of a cosine that
// is 1 to rounding would have no digits.
#ifndef GONIO_HALF_VECTOR_COSINE
#define GONIO_HALF_VECTOR_COSINE

#include "log1p.hlsl"
#include "slope.hlsl"
#include "smallest.hlsl"

// -ln(n.h) of the half vector h, whose length is given: from 0 at the normal to 88 at the horizon.
// (n.h)^e = exp(-e * this). Near the normal (n.h)^-2 = 1 + q, q the square of the slope.
float gonio_minus_log_cosine(float3 h, float h_length) {
  float2 slope = gonio_slope(h);
  float q = slope.x * slope.x + slope.y * slope.y;
  return q < 1.0 ? 0.5 * gonio_log1p(q) : -log(max(h.z / h_length, gonio_smallest));
}

#endif
