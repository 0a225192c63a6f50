// Ashikhmin and Shirley's specular part with one exponent for all azimuths: what Rs multiplies (.x)
// and the rest (.y).
#ifndef GONIO_ASHIKHMIN_SHIRLEY
#define GONIO_ASHIKHMIN_SHIRLEY

#include "ashikhmin_shirley_lobe.hlsl"

float2 gonio_ashikhmin_shirley(float n, float3 h, float3 wi, float3 wo) {
  return gonio_ashikhmin_shirley_lobe(n, n + 1.0, h, wi, wo);
}

#endif
