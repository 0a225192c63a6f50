// The slope of the facet that mirrors wi to wo, from the half vector h = wi + wo, left
// unnormalised: where wi and wo are opposite each other its components are differences that are
// exact.
#ifndef GONIO_SLOPE
#define GONIO_SLOPE

#include "smallest.hlsl"

// (hx/hz, hy/hz). Beyond 1e9 it stays there: no lobe reaches that far.
float2 gonio_slope(float3 h) {
  float z = max(h.z, gonio_smallest);
  return float2(clamp(h.x / z, -1e9, 1e9), clamp(h.y / z, -1e9, 1e9));
}

#endif
