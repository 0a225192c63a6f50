// The coordinate `cosine` of a look-up table: w / reach.
#ifndef GONIO_TABLE_COSINE
#define GONIO_TABLE_COSINE

#include "table_position.hlsl"

// The texture coordinate of w from 0; beyond reach that of more than 1, where the addressing clamps.
float gonio_table_cosine(float w, float inverse_reach, float size) {
  return gonio_table_position(w * inverse_reach, size);
}

#endif
