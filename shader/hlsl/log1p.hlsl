// ln(1 + x) with all the digits of x: a GPU's log() may err by 5e-7 near 1.
#ifndef GONIO_LOG1P
#define GONIO_LOG1P

// For x from -0.5 to 1, as 2 artanh(t) with t = x / (2 + x), |t| <= 1/3: artanh(t) = t (1 + t^2
// p(t^2)), p a minimax fit of this project; relative error 1.1e-8 before rounding.
float gonio_log1p(float x) {
  float t = x / (2.0 + x);
  float z = t * t;
  float p = 0.333333013 + z * (0.200060087 + z * (0.140678437 + z * 0.137238317));
  return 2.0 * t * (1.0 + z * p);
}

#endif
