// Lambert's ideal diffuse reflector, for the albedo 1.
#ifndef GONIO_LAMBERT
#define GONIO_LAMBERT

#include "per_pi.hlsl"

float gonio_lambert() {
  return gonio_per_pi;
}

#endif
