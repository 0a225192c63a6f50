// Duer, On the Ward Model for Global Illumination, 2006, for rho_s = 1:
// E / (4 pi alpha_x alpha_y cos_i cos_o), E = exp(-exponent).
#ifndef GONIO_WARD_DUER
#define GONIO_WARD_DUER

#include "decay.hlsl"
#include "slope.hlsl"
#include "ward_duer_lobe.hlsl"
#include "ward_exponent.hlsl"

float gonio_ward_duer(float alpha_x, float alpha_y, float3 h, float3 wi, float3 wo) {
  float exponent = gonio_ward_exponent(alpha_x, alpha_y, gonio_slope(h));
  return gonio_ward_duer_lobe(gonio_decay(exponent), alpha_x, alpha_y, wi, wo);
}

#endif
