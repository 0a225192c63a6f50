// The coordinate `sqrt` of a look-up table: sqrt(w / reach).
#ifndef GONIO_TABLE_SQRT
#define GONIO_TABLE_SQRT

#include "table_position.hlsl"

// The texture coordinate of w from 0; beyond reach that of 1.
float gonio_table_sqrt(float w, float inverse_reach, float size) {
  return gonio_table_position(sqrt(min(w * inverse_reach, 1.0)), size);
}

#endif
