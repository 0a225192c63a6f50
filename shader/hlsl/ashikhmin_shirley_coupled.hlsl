// Ashikhmin and Shirley's whole model with one exponent for all azimuths: what Rd (1 - Rs)
// multiplies (.x), what Rs multiplies (.y) and the rest (.z).
#ifndef GONIO_ASHIKHMIN_SHIRLEY_COUPLED
#define GONIO_ASHIKHMIN_SHIRLEY_COUPLED

#include "ashikhmin_shirley.hlsl"
#include "ashikhmin_shirley_diffuse.hlsl"

float3 gonio_ashikhmin_shirley_coupled(float n, float3 h, float3 wi, float3 wo) {
  float2 specular = gonio_ashikhmin_shirley(n, h, wi, wo);
  return float3(gonio_ashikhmin_shirley_diffuse(wi, wo), specular.x, specular.y);
}

#endif
