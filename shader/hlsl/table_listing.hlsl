// The coordinate of the published look-up table: (n.h + 1) / 2, whatever its size.
#ifndef GONIO_TABLE_LISTING
#define GONIO_TABLE_LISTING

// The texture coordinate of w = 1 - n.h.
float gonio_table_listing(float w) {
  return 1.0 - 0.5 * w;
}

#endif
