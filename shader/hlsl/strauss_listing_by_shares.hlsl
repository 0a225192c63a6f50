// Strauss's model with the argument of a published shader: x is the cosine of the polar angle,
// which turns the Fresnel effect round. What the colour c multiplies (.x) and the rest (.y), from
// gonio_strauss_shares() or a look-up table of them.
#ifndef GONIO_STRAUSS_LISTING_BY_SHARES
#define GONIO_STRAUSS_LISTING_BY_SHARES

#include "quotient.hlsl"
#include "strauss_reflection.hlsl"
#include "versine.hlsl"

GonioStraussArgument gonio_strauss_cosine(float3 w) {
  GonioStraussArgument argument;
  argument.x = w.z;
  argument.complement = gonio_versine(w);
  argument.x_per_cosine = 1.0;
  argument.complement_per_cosine = gonio_quotient(argument.complement, w.z);
  return argument;
}

float2 gonio_strauss_listing_by_shares(float2 shares, float m, float one_minus_s,
                                       float one_minus_m, float3 wi, float3 wo) {
  return gonio_strauss_reflection(shares, m, one_minus_s, one_minus_m, gonio_strauss_cosine(wi),
                                  gonio_strauss_cosine(wo), wi, wo);
}

#endif
