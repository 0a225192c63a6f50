// What Strauss's model takes from the parameters alone.
#ifndef GONIO_STRAUSS_SHARES
#define GONIO_STRAUSS_SHARES

// d Rd = (1 - m s) (1 - s^3) (1 - t) (.x) and r = s^3 (1 - t) (.y). The differences from 1 are given
// besides: they would lose digits here.
float2 gonio_strauss_shares(float s, float m, float one_minus_s, float one_minus_m,
                            float one_minus_t) {
  float dull = one_minus_m + m * one_minus_s;
  float diffuse = one_minus_s * (1.0 + s + s * s) * one_minus_t;
  return float2(dull * diffuse, s * s * s * one_minus_t);
}

#endif
