// Ashikhmin and Shirley's diffuse part for Rd (1 - Rs) = 1:
// 28 / (23 pi) (1 - (1 - cos_i/2)^5) (1 - (1 - cos_o/2)^5).
#ifndef GONIO_ASHIKHMIN_SHIRLEY_DIFFUSE
#define GONIO_ASHIKHMIN_SHIRLEY_DIFFUSE

#include "ashikhmin_shirley_lobe.hlsl"
#include "per_pi.hlsl"

float gonio_ashikhmin_shirley_diffuse(float3 wi, float3 wo) {
  return 28.0 / 23.0 * gonio_per_pi *
         gonio_one_minus_fifth_power(0.5 * wi.z, 1.0 - 0.5 * wi.z) *
         gonio_one_minus_fifth_power(0.5 * wo.z, 1.0 - 0.5 * wo.z);
}

#endif
