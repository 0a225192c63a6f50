// Ward, Measuring and Modeling Anisotropic Reflection, SIGGRAPH 1992, eq. 4 and 5a, for rho_s = 1:
// E / (4 pi alpha_x alpha_y sqrt(cos_i cos_o)), E = exp(-exponent).
#ifndef GONIO_WARD
#define GONIO_WARD

#include "decay.hlsl"
#include "pi.hlsl"
#include "quotient.hlsl"
#include "slope.hlsl"
#include "ward_exponent.hlsl"

float gonio_ward(float alpha_x, float alpha_y, float3 h, float3 wi, float3 wo) {
  float exponent = gonio_ward_exponent(alpha_x, alpha_y, gonio_slope(h));
  float roots = sqrt(wi.z) * sqrt(wo.z);
  return gonio_quotient(gonio_decay(exponent), 4.0 * gonio_pi * alpha_x * alpha_y * roots);
}

#endif
