// Strauss, A Realistic Lighting Model for Computer Animators, IEEE CG&A 10(6), 1990, for either
// argument x of the Fresnel function F and the attenuation G.
#ifndef GONIO_STRAUSS_REFLECTION
#define GONIO_STRAUSS_REFLECTION

#include "quotient.hlsl"
#include "strauss_sum.hlsl"

// x and 1 - x, and both as multiples of the cosine, with which one of them goes to 0.
struct GonioStraussArgument {
  float x;
  float complement;
  float x_per_cosine;
  float complement_per_cosine;
};

// F(x) / x (.x) and (1 - F(x)) / (1 - x) (.y), kf = 1.12.
float2 gonio_strauss_fresnel(float complement) {
  float distance_to_kf = 0.12 + complement;
  float denominator = 1.24 * distance_to_kf * distance_to_kf;
  return float2(0.0144 * (1.12 + distance_to_kf) / denominator,
                1.2544 * (0.12 + distance_to_kf) / denominator);
}

// G(x), ks = 1.01.
float gonio_strauss_attenuation(float complement) {
  float distance_to_ks = 0.01 + complement;
  return complement * (0.01 + distance_to_ks) * 1.0201 /
         (1.02 * distance_to_ks * distance_to_ks);
}

// What the colour c multiplies (.x) and the rest (.y); `shares` as gonio_strauss_shares().
float2 gonio_strauss_reflection(float2 shares, float m, float one_minus_s, float one_minus_m,
                                GonioStraussArgument i, GonioStraussArgument o, float3 wi,
                                float3 wo) {
  float2 fresnel = gonio_strauss_fresnel(i.complement);
  float j = fresnel.x * i.x * gonio_strauss_attenuation(i.complement) *
            gonio_strauss_attenuation(o.complement);
  float tinted = m * min(fresnel.y * i.complement_per_cosine, gonio_largest);
  float white = one_minus_m * gonio_quotient(1.0, wi.z) +
                m * min(fresnel.x * i.x_per_cosine, gonio_largest);
  return gonio_strauss_sum(shares, j, float2(tinted, white), one_minus_s, wi, wo);
}

#endif
