// Where a coordinate is in a texture.
#ifndef GONIO_TABLE_POSITION
#define GONIO_TABLE_POSITION

// The texture coordinate of c in 0..1 for texels of which the first is centred on 0 and the last,
// of number `size`, on 1: (c (size - 1) + 1/2) / size.
float gonio_table_position(float c, float size) {
  return c * ((size - 1.0) / size) + 0.5 / size;
}

#endif
