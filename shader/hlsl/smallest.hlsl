// Where a GPU's numbers end.
#ifndef GONIO_SMALLEST
#define GONIO_SMALLEST

// Next to the smallest normal number: what is below that may be flushed to 0, and its reciprocal is
// not defined.
static const float gonio_smallest = 1.2e-38;

#endif
