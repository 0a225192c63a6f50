// Strauss's model with the argument of a published shader: x is the cosine of the polar angle,
// which turns the Fresnel effect round. What the colour c multiplies (.x) and the rest (.y).
#ifndef GONIO_STRAUSS_LISTING
#define GONIO_STRAUSS_LISTING

#include "strauss_listing_by_shares.hlsl"
#include "strauss_shares.hlsl"

float2 gonio_strauss_listing(float s, float m, float one_minus_s, float one_minus_m,
                             float one_minus_t, float3 wi, float3 wo) {
  float2 shares = gonio_strauss_shares(s, m, one_minus_s, one_minus_m, one_minus_t);
  return gonio_strauss_listing_by_shares(shares, m, one_minus_s, one_minus_m, wi, wo);
}

#endif
