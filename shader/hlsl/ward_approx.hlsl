// Ward, Measuring and Modeling Anisotropic Reflection, SIGGRAPH 1992, eq. 5b, "computationally
// convenient", for rho_s = 1: as ward.hlsl with the exponent 2 ((hx/alpha_x)^2 + (hy/alpha_y)^2) /
// (1 + hz), h unit.
#ifndef GONIO_WARD_APPROX
#define GONIO_WARD_APPROX

#include "decay.hlsl"
#include "half_vector_length.hlsl"
#include "ward_lobe.hlsl"

float gonio_ward_approx(float alpha_x, float alpha_y, float3 h, float3 wi, float3 wo) {
  float h_length = gonio_half_vector_length(h);
  float u = h.x / h_length / alpha_x;
  float v = h.y / h_length / alpha_y;
  float exponent = 2.0 * (u * u + v * v) / (1.0 + h.z / h_length);
  return gonio_ward_lobe(gonio_decay(exponent), alpha_x, alpha_y, wi, wo);
}

#endif
