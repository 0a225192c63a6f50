// Ashikhmin & Shirley, An Anisotropic Phong Light Reflection Model, University of Utah UUCS-00-014,
// 2000: the specular part. The Fresnel factor is Schlick's of 1994.
#ifndef GONIO_ASHIKHMIN_SHIRLEY_LOBE
#define GONIO_ASHIKHMIN_SHIRLEY_LOBE

#include "decay.hlsl"
#include "half_vector_cosine.hlsl"
#include "half_vector_length.hlsl"
#include "pi.hlsl"
#include "quotient.hlsl"

// 1 - (1 - x)^5 from x and 1 - x: a sum of positive numbers, which cancels nothing.
float gonio_one_minus_fifth_power(float x, float one_minus_x) {
  float y = one_minus_x;
  return min(x * (1.0 + y * (1.0 + y * (1.0 + y * (1.0 + y)))), 1.0);
}

// F(h.wi) = Rs * .x + .y, from h.wi = |wi + wo| / 2 and 1 - h.wi = |wi - wo|^2 / (4 (1 + h.wi)):
// the dot product has no digits left at grazing angles.
float2 gonio_schlick_fresnel(float3 wi, float3 wo, float h_length) {
  float x = min(0.5 * h_length, 1.0);
  float3 d = wi - wo;
  float one_minus_x = min((d.x * d.x + d.y * d.y + d.z * d.z) / (4.0 * (1.0 + x)), 1.0);
  float square = one_minus_x * one_minus_x;
  return float2(gonio_one_minus_fifth_power(x, one_minus_x), square * square * one_minus_x);
}

// normalisation / (8 pi) (n.h)^exponent / ((h.wi) max(cos_i, cos_o)) F(h.wi): what Rs multiplies
// (.x) and the rest (.y).
float2 gonio_ashikhmin_shirley_lobe(float exponent, float normalisation, float3 h, float3 wi,
                                    float3 wo) {
  float h_length = gonio_half_vector_length(h);
  float projections = 0.5 * h_length * max(wi.z, wo.z);
  float decay = gonio_decay(exponent * gonio_minus_log_cosine(h, h_length));
  float lobe = gonio_quotient(decay, 8.0 * gonio_pi * projections / normalisation);
  return lobe * gonio_schlick_fresnel(wi, wo, h_length);
}

#endif
