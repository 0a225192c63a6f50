// Ashikhmin and Shirley's specular part with the exponents nu along the tangent and nv along the
// bitangent: what Rs multiplies (.x) and the rest (.y).
#ifndef GONIO_ASHIKHMIN_SHIRLEY_ANISO
#define GONIO_ASHIKHMIN_SHIRLEY_ANISO

#include "ashikhmin_shirley_lobe.hlsl"
#include "smallest.hlsl"

// nu cos^2(phi) + nv sin^2(phi) of the half vector's azimuth; nu at the pole, where n.h is 1.
float gonio_exponent_at_azimuth(float nu, float nv, float3 h) {
  float scale = max(abs(h.x), abs(h.y));
  if (scale < gonio_smallest) return nu;
  float x = h.x / scale;
  float y = h.y / scale;
  float square = x * x + y * y;
  return nu * (x * x / square) + nv * (y * y / square);
}

float2 gonio_ashikhmin_shirley_aniso(float nu, float nv, float3 h, float3 wi, float3 wo) {
  return gonio_ashikhmin_shirley_lobe(gonio_exponent_at_azimuth(nu, nv, h),
                                      sqrt(nu + 1.0) * sqrt(nv + 1.0), h, wi, wo);
}

#endif
