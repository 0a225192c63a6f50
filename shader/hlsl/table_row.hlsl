// The row of a look-up table whose rows are evenly spaced in the logarithm of a parameter.
#ifndef GONIO_TABLE_ROW
#define GONIO_TABLE_ROW

#include "table_position.hlsl"

// The texture coordinate of the row of the parameter, clamped to the first, of the parameter
// 1 / inverse_lowest, and the last; log_range is the logarithm of the last over the first.
float gonio_table_row(float parameter, float inverse_lowest, float log_range, float size) {
  return gonio_table_position(clamp(log(parameter * inverse_lowest) / log_range, 0.0, 1.0), size);
}

#endif
