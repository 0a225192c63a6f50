// A baked look-up table.
#pragma once

#include <array>

#include "lut/layout.h"
#include "lut/texture.h"

namespace gonio::lut {

/// How a channel's value is found from what the texture gives: scale * texel. 1 but for
/// ward-exponent, whose scale is chosen for the largest alpha served: the integers cover
/// -negligible_decay highest^2 .. 0, with 0 at the texel 0; r16f holds the same in -2^15 .. 0,
/// scaled by a power of two, so that lobes up to most_alphas_of_half times narrower end above the
/// smallest half floats too.
struct Decoding {
  float scale = 1;
};

struct Table {
  Layout layout;
  Texture texture;
  std::array<Decoding, most_channels> decoding;
};

/// The decoding that the layout's storage needs, known before the table is baked.
std::array<Decoding, most_channels> decoding_of(const Layout& layout);

/// ward-exponent: a value from here down means that the lobe is 0, and the last texel holds it (not
/// in `listing`): a lobe's denominator may be as small as it likes. -1e30 for r32f, of which
/// exp(value / alpha^2) is 0 and the argument finite for every alpha; for the others the end of
/// what they hold (the texel 1, and -65504), where a shader has to compare.
float end_of_exponent(const Layout& layout);

/// Computes every texel in double and stores it; `listing` in float, as published. Throws as
/// check().
Table bake(const Layout& layout);

/// The values at w of the first axis and the row (ward-lobe: alpha, blinn-phong-power: exponent);
/// strauss-j: w of wi and of wo; strauss-terms: s and m.
template <class T>
std::array<T, most_channels> look_up(const Table& table, T first, T second, Filter filter,
                                     Weights weights = Weights::exact);

}  // namespace gonio::lut
