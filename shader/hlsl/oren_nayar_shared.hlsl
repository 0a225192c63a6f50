// What both forms of Oren and Nayar's model share.
#ifndef GONIO_OREN_NAYAR_SHARED
#define GONIO_OREN_NAYAR_SHARED

#include "quotient.hlsl"

// sigma^2 / (sigma^2 + offset): how everything grows with roughness.
float gonio_oren_nayar_growth(float sigma, float offset) {
  return sigma * sigma / (sigma * sigma + offset);
}

// max(0, cos(dphi)) sin(a) tan(b) for the larger polar angle a and the smaller b: both polar sines
// are in the dot product of the horizontal components.
float gonio_oren_nayar_same_side(float3 wi, float3 wo) {
  return gonio_quotient(max(wi.x * wo.x + wi.y * wo.y, 0.0), max(wi.z, wo.z));
}

#endif
