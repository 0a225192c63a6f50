// Strauss's model with its Fresnel term and attenuation from a look-up table, for either argument of
// them. What the colour c multiplies (.x) and the rest (.y).
#ifndef GONIO_STRAUSS_BY_J
#define GONIO_STRAUSS_BY_J

#include "quotient.hlsl"
#include "strauss_shares.hlsl"
#include "strauss_sum.hlsl"

// `read` is j = F(x_i) G(x_i) G(x_o) (.x) and 1 - F(x_i) (.y), both 0 to 1.
float2 gonio_strauss_by_j(float2 read, float s, float m, float one_minus_s, float one_minus_m,
                          float one_minus_t, float3 wi, float3 wo) {
  float2 shares = gonio_strauss_shares(s, m, one_minus_s, one_minus_m, one_minus_t);
  float per_cosine = gonio_quotient(1.0, wi.z);
  float2 highlight = float2(m * read.y * per_cosine,
                            (one_minus_m + m * (1.0 - read.y)) * per_cosine);
  return gonio_strauss_sum(shares, read.x, highlight, one_minus_s, wi, wo);
}

#endif
