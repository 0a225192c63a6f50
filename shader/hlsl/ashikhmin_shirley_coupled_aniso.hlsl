// Ashikhmin and Shirley's whole model with the exponents nu along the tangent and nv along the
// bitangent: what Rd (1 - Rs) multiplies (.x), what Rs multiplies (.y) and the rest (.z).
#ifndef GONIO_ASHIKHMIN_SHIRLEY_COUPLED_ANISO
#define GONIO_ASHIKHMIN_SHIRLEY_COUPLED_ANISO

#include "ashikhmin_shirley_aniso.hlsl"
#include "ashikhmin_shirley_diffuse.hlsl"

float3 gonio_ashikhmin_shirley_coupled_aniso(float nu, float nv, float3 h, float3 wi, float3 wo) {
  float2 specular = gonio_ashikhmin_shirley_aniso(nu, nv, h, wi, wo);
  return float3(gonio_ashikhmin_shirley_diffuse(wi, wo), specular.x, specular.y);
}

#endif
