// 1 minus the cosine of the polar angle.
#ifndef GONIO_VERSINE
#define GONIO_VERSINE

// 1 - n.w of a unit vector w above the horizon, as the square of its sine over 1 + n.w: the
// difference would have no digits near the normal.
float gonio_versine(float3 w) {
  return (w.x * w.x + w.y * w.y) / (1.0 + w.z);
}

#endif
