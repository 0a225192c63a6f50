// The numerator of Ward's lobes from the exponent of a look-up table.
#ifndef GONIO_TABLE_DECAY
#define GONIO_TABLE_DECAY

#include "decay.hlsl"

// exp(value * inverse_alpha2) for a value of at most 0; 0 from the table's end, where the value
// stands for all below.
float gonio_table_decay(float value, float inverse_alpha2, float end) {
  return value > end ? gonio_decay(-value * inverse_alpha2) : 0.0;
}

#endif
