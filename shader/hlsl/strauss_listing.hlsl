// Strauss's model with the argument of a published shader: x is the cosine of the polar angle,
// which turns the Fresnel effect round. What the colour c multiplies (.x) and the rest (.y).
#ifndef GONIO_STRAUSS_LISTING
#define GONIO_STRAUSS_LISTING

#include "polar_sine.hlsl"
#include "quotient.hlsl"
#include "strauss_reflection.hlsl"

GonioStraussArgument gonio_strauss_cosine(float3 w) {
  float sine = gonio_polar_sine(w);
  GonioStraussArgument argument;
  argument.x = w.z;
  argument.complement = sine * sine / (1.0 + w.z);
  argument.x_per_cosine = 1.0;
  argument.complement_per_cosine = gonio_quotient(argument.complement, w.z);
  return argument;
}

float2 gonio_strauss_listing(float s, float m, float one_minus_s, float one_minus_m,
                             float one_minus_t, float3 wi, float3 wo) {
  GonioStraussShape shape = gonio_strauss_shape(s, m, one_minus_s, one_minus_m, one_minus_t);
  return gonio_strauss_reflection(shape, gonio_strauss_cosine(wi), gonio_strauss_cosine(wo), wi,
                                  wo);
}

#endif
