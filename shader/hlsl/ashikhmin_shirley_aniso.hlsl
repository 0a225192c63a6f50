// Ashikhmin and Shirley's specular part with the exponents nu along the tangent and nv along the
// bitangent: what Rs multiplies (.x) and the rest (.y).
#ifndef GONIO_ASHIKHMIN_SHIRLEY_ANISO
#define GONIO_ASHIKHMIN_SHIRLEY_ANISO

#include "ashikhmin_shirley_lobe.hlsl"
#include "at_azimuth.hlsl"

// The exponent at the pole, where n.h is 1, may be any.
float2 gonio_ashikhmin_shirley_aniso(float nu, float nv, float3 h, float3 wi, float3 wo) {
  return gonio_ashikhmin_shirley_lobe(gonio_at_azimuth(nu, nv, h),
                                      sqrt(nu + 1.0) * sqrt(nv + 1.0), h, wi, wo);
}

#endif
