// Strauss, A Realistic Lighting Model for Computer Animators, IEEE CG&A 10(6), 1990, for either
// argument x of the Fresnel function F and the attenuation G.
#ifndef GONIO_STRAUSS_REFLECTION
#define GONIO_STRAUSS_REFLECTION

#include "mirror_lobe.hlsl"
#include "per_pi.hlsl"
#include "quotient.hlsl"

// x and 1 - x, and both as multiples of the cosine, with which one of them goes to 0.
struct GonioStraussArgument {
  float x;
  float complement;
  float x_per_cosine;
  float complement_per_cosine;
};

// The parameters, with their differences from 1, which would lose digits here.
struct GonioStraussShape {
  float s;
  float m;
  float one_minus_s;
  float one_minus_m;
  float one_minus_t;
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

// max(0, r.wo)^(3/(1-s)). At s = 1 its limit: 1 where wo is the mirror direction to the rounding of
// the vectors (16 epsilon^2 of float), else 0.
float gonio_strauss_lobe(float one_minus_s, float3 wi, float3 wo) {
  // The larger of the two: a compiler that knows s = 1 sees no division by zero.
  if (one_minus_s > 0.0) {
    return gonio_mirror_lobe(3.0 / max(one_minus_s, gonio_smallest), wi, wo);
  }
  return gonio_minus_log_mirror_cosine(wi, wo) > 2.3e-13 ? 0.0 : 1.0;
}

GonioStraussShape gonio_strauss_shape(float s, float m, float one_minus_s, float one_minus_m,
                                      float one_minus_t) {
  GonioStraussShape shape;
  shape.s = s;
  shape.m = m;
  shape.one_minus_s = one_minus_s;
  shape.one_minus_m = one_minus_m;
  shape.one_minus_t = one_minus_t;
  return shape;
}

// What the colour c multiplies (.x) and the rest (.y).
float2 gonio_strauss_reflection(GonioStraussShape shape, GonioStraussArgument i,
                                GonioStraussArgument o, float3 wi, float3 wo) {
  float2 fresnel = gonio_strauss_fresnel(i.complement);
  float j = fresnel.x * i.x * gonio_strauss_attenuation(i.complement) *
            gonio_strauss_attenuation(o.complement);

  float s = shape.s;
  float dull = shape.one_minus_m + shape.m * shape.one_minus_s;  // d = 1 - m s
  float diffuse = shape.one_minus_s * (1.0 + s + s * s) * shape.one_minus_t;  // Rd
  float r = s * s * s * shape.one_minus_t;
  float reflected = min(r + j * (r + 0.1), 1.0);  // R
  float highlight = gonio_per_pi * gonio_strauss_lobe(shape.one_minus_s, wi, wo) * reflected;

  float tinted = shape.m * min(fresnel.y * i.complement_per_cosine, gonio_largest);
  float white = shape.one_minus_m * gonio_quotient(1.0, wi.z) +
                shape.m * min(fresnel.x * i.x_per_cosine, gonio_largest);
  return float2(gonio_per_pi * dull * diffuse + highlight * tinted, highlight * white);
}

#endif
