// The coordinate `fourth-root` of a look-up table: sqrt(sqrt(w / reach)).
#ifndef GONIO_TABLE_FOURTH_ROOT
#define GONIO_TABLE_FOURTH_ROOT

#include "table_position.hlsl"

// The texture coordinate of w from 0; beyond reach that of 1.
float gonio_table_fourth_root(float w, float inverse_reach, float size) {
  return gonio_table_position(sqrt(sqrt(min(w * inverse_reach, 1.0))), size);
}

#endif
