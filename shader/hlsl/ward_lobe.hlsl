// Ward, Measuring and Modeling Anisotropic Reflection, SIGGRAPH 1992, eq. 4 and 5a, for rho_s = 1:
// the lobe for the numerator E, E / (4 pi alpha_x alpha_y sqrt(cos_i cos_o)).
#ifndef GONIO_WARD_LOBE
#define GONIO_WARD_LOBE

#include "pi.hlsl"
#include "quotient.hlsl"

float gonio_ward_lobe(float numerator, float alpha_x, float alpha_y, float3 wi, float3 wo) {
  float roots = sqrt(wi.z) * sqrt(wo.z);
  return gonio_quotient(numerator, 4.0 * gonio_pi * alpha_x * alpha_y * roots);
}

#endif
