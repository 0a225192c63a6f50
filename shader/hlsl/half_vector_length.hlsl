// The length of the unnormalised half vector.
#ifndef GONIO_HALF_VECTOR_LENGTH
#define GONIO_HALF_VECTOR_LENGTH

#include "smallest.hlsl"

// |h|, also where the squares of its components would underflow.
float gonio_half_vector_length(float3 h) {
  float scale = max(max(abs(h.x), abs(h.y)), max(h.z, gonio_smallest));
  float x = h.x / scale;
  float y = h.y / scale;
  float z = h.z / scale;
  return scale * sqrt(x * x + y * y + z * z);
}

#endif
