// Phong, Illumination for Computer Generated Pictures, CACM 18(6), 1975: the lobe about the mirror
// direction, for the peak 1/sr; no normalisation, and no cosine divided out.
#ifndef GONIO_PHONG
#define GONIO_PHONG

#include "mirror_lobe.hlsl"

float gonio_phong(float exponent, float3 wi, float3 wo) {
  return gonio_mirror_lobe(exponent, wi, wo);
}

#endif
