// Ward, Measuring and Modeling Anisotropic Reflection, SIGGRAPH 1992, eq. 4 and 5a, for rho_s = 1:
// E / (4 pi alpha_x alpha_y sqrt(cos_i cos_o)), E = exp(-exponent).
#ifndef GONIO_WARD
#define GONIO_WARD

#include "decay.hlsl"
#include "slope.hlsl"
#include "ward_exponent.hlsl"
#include "ward_lobe.hlsl"

float gonio_ward(float alpha_x, float alpha_y, float3 h, float3 wi, float3 wo) {
  float exponent = gonio_ward_exponent(alpha_x, alpha_y, gonio_slope(h));
  return gonio_ward_lobe(gonio_decay(exponent), alpha_x, alpha_y, wi, wo);
}

#endif
