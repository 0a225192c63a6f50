// From linear radiance to the 8 bits of a display: exposure, clamp, sRGB curve (IEC 61966-2-1).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/image.h"

namespace gonio::render {

/// The sRGB curve: a linear value of 0..1, to which it is clamped, as a display value of 0..1.
double srgb_of(double linear);

/// [y][x] red, green, blue and alpha as a PNG holds them: radiance times 2^exposure under the sRGB
/// curve, not associated with alpha; alpha is linear. Transparent pixels are all 0.
std::vector<std::array<std::uint8_t, 4>> display_pixels(const Image& image, double exposure);

}  // namespace gonio::render
