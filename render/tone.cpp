#include "render/tone.h"

#include <algorithm>
#include <cmath>

namespace gonio::render {
namespace {

std::uint8_t in_8_bits(double value) { return std::uint8_t(std::lround(255 * value)); }

}  // namespace

double srgb_of(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
}

std::vector<std::array<std::uint8_t, 4>> display_pixels(const Image& image, double exposure) {
  const double gain = std::exp2(exposure);
  std::vector<std::array<std::uint8_t, 4>> display(image.pixels.size());
  for (std::size_t i = 0; i < display.size(); ++i) {
    const Rgba& pixel = image.pixels[i];
    if (pixel[3] <= 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      display[i][c] = in_8_bits(srgb_of(gain * double(pixel[c]) / double(pixel[3])));
    }
    display[i][3] = in_8_bits(std::min(double(pixel[3]), 1.0));
  }
  return display;
}

}  // namespace gonio::render
