// The coordinate `sqrt` of a look-up table: sqrt(w / reach).
#ifndef GONIO_TABLE_SQRT
#define GONIO_TABLE_SQRT

#include "table_position.hlsl"

// The texture coordinate of w from 0; beyond reach that of more than 1, where the addressing clamps.
float gonio_table_sqrt(float w, float inverse_reach, float size) {
  return gonio_table_position(sqrt(w * inverse_reach), size);
}

#endif
