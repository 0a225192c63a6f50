#include "render/image.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace gonio::render {
namespace {

void require_same_size(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height) {
    throw std::invalid_argument("images of different sizes cannot be put together");
  }
}

/// Copies the image to where its top left corner is at (left, top).
void paste(const Image& image, std::size_t left, std::size_t top, Image& target) {
  const auto width = std::size_t(image.width);
  for (std::size_t y = 0; y < std::size_t(image.height); ++y) {
    const auto row = image.pixels.begin() + std::ptrdiff_t(y * width);
    std::copy(row, row + std::ptrdiff_t(width),
              target.pixels.begin() + std::ptrdiff_t((top + y) * std::size_t(target.width) + left));
  }
}

}  // namespace

Image sheet(std::span<const Image> images, int columns) {
  if (images.empty() || columns < 1) {
    throw std::invalid_argument("a sheet needs an image and a column at least");
  }
  const Image& first = images.front();
  const std::size_t across = std::min(std::size_t(columns), images.size());
  const std::size_t down = (images.size() + across - 1) / across;
  Image whole{int(across) * first.width, int(down) * first.height, {}};
  whole.pixels.resize(std::size_t(whole.width) * std::size_t(whole.height));
  for (std::size_t i = 0; i < images.size(); ++i) {
    require_same_size(first, images[i]);
    paste(images[i], i % across * std::size_t(first.width), i / across * std::size_t(first.height),
          whole);
  }
  return whole;
}

Image difference(const Image& a, const Image& b, double amplification) {
  require_same_size(a, b);
  Image result = a;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double apart = std::abs(double(a.pixels[i][c]) - double(b.pixels[i][c]));
      result.pixels[i][c] = saturated(apart * amplification);
    }
  }
  return result;
}

double largest_colour(const Image& image) {
  double largest = 0;
  for (const Rgba& pixel : image.pixels) {
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, double(pixel[c]));
  }
  return largest;
}

}  // namespace gonio::render
