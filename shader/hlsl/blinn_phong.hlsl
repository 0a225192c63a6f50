// Blinn, Models of Light Reflection for Computer Synthesized Pictures, SIGGRAPH 1977:
// (n.h)^exponent for the peak 1/sr; no normalisation, and no cosine divided out.
#ifndef GONIO_BLINN_PHONG
#define GONIO_BLINN_PHONG

#include "decay.hlsl"
#include "half_vector_cosine.hlsl"
#include "half_vector_length.hlsl"

float gonio_blinn_phong(float exponent, float3 h) {
  return gonio_decay(exponent * gonio_minus_log_cosine(h, gonio_half_vector_length(h)));
}

#endif
