// Division that neither overflows nor gives infinity or NaN, which a GPU need not have.
#ifndef GONIO_QUOTIENT
#define GONIO_QUOTIENT

#include "smallest.hlsl"

// What a basis function saturates at, in 1/sr. f_r is above it closer than 3e-6 rad to the horizon
// only, for a roughness of 1e-4.
static const float gonio_largest = 1e18;

// numerator / denominator, at most gonio_largest. The numerator is 0 to 2, the denominator at
// least 0.
float gonio_quotient(float numerator, float denominator) {
  return min(numerator / max(denominator, gonio_smallest), gonio_largest);
}

#endif
