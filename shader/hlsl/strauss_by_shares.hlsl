// Strauss's model with the argument of his article: x is the polar angle over pi/2. What the colour
// c multiplies (.x) and the rest (.y), from gonio_strauss_shares() or a look-up table of them.
#ifndef GONIO_STRAUSS_BY_SHARES
#define GONIO_STRAUSS_BY_SHARES

#include "polar_sine.hlsl"
#include "quarter_turns.hlsl"
#include "quotient.hlsl"
#include "strauss_reflection.hlsl"

GonioStraussArgument gonio_strauss_angle(float3 w) {
  float sine = gonio_polar_sine(w);
  GonioStraussArgument argument;
  argument.x = gonio_quarter_turns(sine, w.z);
  argument.complement = gonio_quarter_turns(w.z, sine);
  argument.x_per_cosine = gonio_quotient(argument.x, w.z);
  argument.complement_per_cosine = gonio_quotient(argument.complement, w.z);
  return argument;
}

float2 gonio_strauss_by_shares(float2 shares, float m, float one_minus_s, float one_minus_m,
                               float3 wi, float3 wo) {
  return gonio_strauss_reflection(shares, m, one_minus_s, one_minus_m, gonio_strauss_angle(wi),
                                  gonio_strauss_angle(wo), wi, wo);
}

#endif
