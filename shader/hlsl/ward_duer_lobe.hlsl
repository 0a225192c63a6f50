// Duer, On the Ward Model for Global Illumination, 2006, for rho_s = 1: the lobe for the numerator
// E, E / (4 pi alpha_x alpha_y cos_i cos_o).
#ifndef GONIO_WARD_DUER_LOBE
#define GONIO_WARD_DUER_LOBE

#include "pi.hlsl"
#include "quotient.hlsl"

float gonio_ward_duer_lobe(float numerator, float alpha_x, float alpha_y, float3 wi, float3 wo) {
  return gonio_quotient(numerator, 4.0 * gonio_pi * alpha_x * alpha_y * wi.z * wo.z);
}

#endif
