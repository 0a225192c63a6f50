// A picture in memory: linear radiance of red, green and blue with coverage.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace gonio::render {

/// Red, green and blue.
using Rgb = std::array<float, 3>;

/// A value of at least 0 as a float, which saturates.
inline float saturated(double value) {
  return float(std::min(value, double(std::numeric_limits<float>::max())));
}

/// Red, green, blue and alpha: the share of the pixel that is covered. The colours are associated,
/// that is, those of the covered share times alpha.
using Rgba = std::array<float, 4>;

/// Rows run from the top to the bottom, pixels from left to right.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Rgba> pixels;  // [y][x]
};

/// Images side by side, row after row of `columns`, on a transparent ground. All are of one size.
/// Throws std::invalid_argument if they are not, if there are none, or if `columns` is below 1.
Image sheet(std::span<const Image> images, int columns);

/// |a - b| * amplification in each colour, with the alpha of `a`. Both are of one size, else it
/// throws std::invalid_argument.
Image difference(const Image& a, const Image& b, double amplification);

/// The largest value of any colour of any pixel; 0 at least.
double largest_colour(const Image& image);

}  // namespace gonio::render
