// Strauss, A Realistic Lighting Model for Computer Animators, IEEE CG&A 10(6), 1990: the sum, once
// the Fresnel term and the attenuation are known.
#ifndef GONIO_STRAUSS_SUM
#define GONIO_STRAUSS_SUM

#include "mirror_lobe.hlsl"
#include "per_pi.hlsl"

// max(0, r.wo)^(3/(1-s)). At s = 1 its limit: 1 where wo is the mirror direction to the rounding of
// the vectors (16 epsilon^2 of float), else 0.
float gonio_strauss_lobe(float one_minus_s, float3 wi, float3 wo) {
  // The larger of the two: a compiler that knows s = 1 sees no division by zero.
  if (one_minus_s > 0.0) {
    return gonio_mirror_lobe(3.0 / max(one_minus_s, gonio_smallest), wi, wo);
  }
  return gonio_minus_log_mirror_cosine(wi, wo) > 2.3e-13 ? 0.0 : 1.0;
}

// What the colour c multiplies (.x) and the rest (.y). `shares` as gonio_strauss_shares();
// `highlight` is m (1 - F) / cos_i (.x) and (1 - m (1 - F)) / cos_i (.y).
float2 gonio_strauss_sum(float2 shares, float j, float2 highlight, float one_minus_s, float3 wi,
                         float3 wo) {
  float reflected = min(shares.y + j * (shares.y + 0.1), 1.0);  // R
  float lobe = gonio_per_pi * gonio_strauss_lobe(one_minus_s, wi, wo) * reflected;
  return float2(gonio_per_pi * shares.x + lobe * highlight.x, lobe * highlight.y);
}

#endif
