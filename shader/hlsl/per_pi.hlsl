// 1 / pi.
#ifndef GONIO_PER_PI
#define GONIO_PER_PI

static const float gonio_per_pi = 0.318309886183790672;

#endif
