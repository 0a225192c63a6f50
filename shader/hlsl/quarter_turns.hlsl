// The polar angle as a share of the right angle, never through the acos of a cosine, which knows
// small angles to one digit only.
#ifndef GONIO_QUARTER_TURNS
#define GONIO_QUARTER_TURNS

#include "smallest.hlsl"

// (2/pi) theta from sine and cosine, both from 0: 0 at the normal, 1 on the horizon; with the two
// exchanged it is the complement to 1. Accurate where it is small. A GPU's atan() may err by 4096
// units in the last place: for |t| <= tan(pi/8) it is t (1 + t^2 p(t^2)) here, p a minimax fit of
// this project; relative error 2.3e-8 before rounding.
float gonio_quarter_turns(float sine, float cosine) {
  float lesser = min(sine, cosine);
  float greater = max(max(sine, cosine), gonio_smallest);
  bool beyond = lesser > 0.414213562 * greater;  // atan(t) = pi/4 - atan((1 - t) / (1 + t))
  float t = beyond ? (greater - lesser) / (greater + lesser) : lesser / greater;
  float z = t * t;
  float p = -0.333329287 + z * (0.199770831 + z * (-0.138720263 + z * 0.0803784745));
  float turns = 0.636619772367581343 * t * (1.0 + z * p);
  if (beyond) turns = 0.5 - turns;
  return sine > cosine ? 1.0 - turns : turns;
}

#endif
