// The coordinate `fourth-root` of a look-up table: sqrt(sqrt(w / reach)).
#ifndef GONIO_TABLE_FOURTH_ROOT
#define GONIO_TABLE_FOURTH_ROOT

#include "table_position.hlsl"

// The texture coordinate of w from 0; beyond reach that of more than 1, where the addressing clamps.
float gonio_table_fourth_root(float w, float inverse_reach, float size) {
  return gonio_table_position(sqrt(sqrt(w * inverse_reach)), size);
}

#endif
