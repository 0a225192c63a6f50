// The coordinate `cosine` of a look-up table: w / reach.
#ifndef GONIO_TABLE_COSINE
#define GONIO_TABLE_COSINE

#include "table_position.hlsl"

// The texture coordinate of w from 0; beyond reach that of 1.
float gonio_table_cosine(float w, float inverse_reach, float size) {
  return gonio_table_position(min(w * inverse_reach, 1.0), size);
}

#endif
