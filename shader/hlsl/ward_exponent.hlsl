// The exponent that Ward's lobes share, but for ward-approx.
#ifndef GONIO_WARD_EXPONENT
#define GONIO_WARD_EXPONENT

// ((hx/alpha_x)^2 + (hy/alpha_y)^2) / hz^2 from the half vector's slope (hx/hz, hy/hz).
float gonio_ward_exponent(float alpha_x, float alpha_y, float2 slope) {
  float u = slope.x / alpha_x;
  float v = slope.y / alpha_y;
  return u * u + v * v;
}

#endif
