// A number that turns with the azimuth from one value along the tangent to another along the
// bitangent.
#ifndef GONIO_AT_AZIMUTH
#define GONIO_AT_AZIMUTH

#include "smallest.hlsl"

// along cos^2(phi) + across sin^2(phi) of the half vector's azimuth; `along` at the pole, where
// there is none.
float gonio_at_azimuth(float along, float across, float3 h) {
  float scale = max(abs(h.x), abs(h.y));
  if (scale < gonio_smallest) return along;
  float x = h.x / scale;
  float y = h.y / scale;
  float square = x * x + y * y;
  return along * (x * x / square) + across * (y * y / square);
}

#endif
