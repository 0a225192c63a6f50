// The exponential function where it decays.
#ifndef GONIO_DECAY
#define GONIO_DECAY

// exp(-x) for x from 0, however large: exactly 0 where it is below the smallest normal number.
float gonio_decay(float x) {
  return x < 87.0 ? exp(-x) : 0.0;
}

#endif
