// Powers of the cosine between wo and the mirror image r of wi: the lobe of Phong and of Strauss.
#ifndef GONIO_MIRROR_LOBE
#define GONIO_MIRROR_LOBE

#include "decay.hlsl"
#include "log1p.hlsl"
#include "smallest.hlsl"

// -ln(r.wo) for r = (-wi.x, -wi.y, wi.z): 0 where wo is the mirror direction; 88 where r.wo is not
// positive. Near the mirror direction r.wo = 1 - d.d/2, d = wo - r, whose digits the dot product
// loses.
float gonio_minus_log_mirror_cosine(float3 wi, float3 wo) {
  float3 d = float3(wi.x + wo.x, wi.y + wo.y, wi.z - wo.z);
  float half_distance2 = 0.5 * (d.x * d.x + d.y * d.y + d.z * d.z);
  float cosine = wi.z * wo.z - wi.x * wo.x - wi.y * wo.y;
  return half_distance2 < 0.5 ? -gonio_log1p(-half_distance2) : -log(max(cosine, gonio_smallest));
}

// max(0, r.wo)^exponent; 0 where r.wo <= 0, also for the exponent 0.
float gonio_mirror_lobe(float exponent, float3 wi, float3 wo) {
  float minus_log = gonio_minus_log_mirror_cosine(wi, wo);
  return minus_log < 87.0 ? gonio_decay(exponent * minus_log) : 0.0;
}

#endif
