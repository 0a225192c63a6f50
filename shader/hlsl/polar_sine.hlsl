// The sine of the polar angle.
#ifndef GONIO_POLAR_SINE
#define GONIO_POLAR_SINE

// sin(theta) of a unit vector.
float gonio_polar_sine(float3 w) {
  return sqrt(w.x * w.x + w.y * w.y);
}

#endif
