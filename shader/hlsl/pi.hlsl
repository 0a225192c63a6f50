// Pi.
#ifndef GONIO_PI
#define GONIO_PI

static const float gonio_pi = 3.14159265358979324;

#endif
