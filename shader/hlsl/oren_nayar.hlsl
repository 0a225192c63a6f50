// Oren & Nayar, Generalization of Lambert's Reflectance Model, SIGGRAPH 1994, the simplified form
// A + B max(0, cos(dphi)) sin(a) tan(b), for the albedo 1.
#ifndef GONIO_OREN_NAYAR
#define GONIO_OREN_NAYAR

#include "oren_nayar_shared.hlsl"
#include "per_pi.hlsl"

float gonio_oren_nayar(float sigma, float3 wi, float3 wo) {
  float a = 1.0 - 0.5 * gonio_oren_nayar_growth(sigma, 0.33);
  float b = 0.45 * gonio_oren_nayar_growth(sigma, 0.09);
  return gonio_per_pi * (a + b * gonio_oren_nayar_same_side(wi, wo));
}

#endif
