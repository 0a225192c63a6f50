#include "lut/texture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio::lut {
namespace {

/// Two neighbouring texels along an axis and the share of the second.
template <class T>
struct Neighbours {
  std::size_t first;
  std::size_t second;
  T weight;
};

/// u in 0..1, which changes nothing: both neighbours beyond the ends are the outermost texel.
template <class T>
T inside(T u) {
  return u > T(0) ? std::min(u, T(1)) : T(0);
}

std::size_t clamped(int i, int size) {
  return static_cast<std::size_t>(std::clamp(i, 0, size - 1));
}

template <class T>
Neighbours<T> neighbours(T u, int size, Filter filter, Weights weights) {
  const T scaled = inside(u) * static_cast<T>(size);
  if (filter == Filter::nearest) {
    const std::size_t i = clamped(static_cast<int>(scaled), size);
    return {i, i, T(0)};
  }
  const T position = scaled - T(0.5);
  const T below = std::floor(position);
  const T exact = position - below;
  const int i = static_cast<int>(below);
  const T weight = weights == Weights::exact ? exact : std::floor(exact * T(256) + T(0.5)) / T(256);
  return {clamped(i, size), clamped(i + 1, size), weight};
}

template <class T>
T blend(T first, T second, T weight) {
  return first + weight * (second - first);
}

/// Rounds to nearest even in steps of 2^-10 of the leading power of two; below 2^-14 the steps
/// stay.
double rounded_to_half(double value) {
  constexpr double largest = 65504;
  constexpr int smallest_step = -24;
  const double cut = std::clamp(value, -largest, largest);
  const int step = cut == 0 ? smallest_step : std::max(std::ilogb(cut) - 10, smallest_step);
  return std::ldexp(std::nearbyint(std::ldexp(cut, -step)), step);
}

double rounded_to_unorm(double value, double largest_code) {
  return std::nearbyint(std::clamp(value, 0.0, 1.0) * largest_code) / largest_code;
}

}  // namespace

std::string_view name_of(Storage storage) {
  switch (storage) {
    case Storage::r32f:
      return "r32f";
    case Storage::r16f:
      return "r16f";
    case Storage::unorm16:
      return "unorm16";
    case Storage::unorm8:
      return "unorm8";
  }
  return {};
}

std::string_view name_of(Filter filter) { return filter == Filter::linear ? "linear" : "nearest"; }

std::size_t bytes_per_channel(Storage storage) {
  switch (storage) {
    case Storage::r32f:
      return 4;
    case Storage::r16f:
    case Storage::unorm16:
      return 2;
    case Storage::unorm8:
      return 1;
  }
  return 0;
}

std::size_t bytes_of(const Texture& texture) {
  return texture.texels.size() * bytes_per_channel(texture.storage);
}

float stored(double value, Storage storage) {
  constexpr double largest = std::numeric_limits<float>::max();
  switch (storage) {
    case Storage::r32f:
      return static_cast<float>(std::clamp(value, -largest, largest));
    case Storage::r16f:
      return static_cast<float>(rounded_to_half(value));
    case Storage::unorm16:
      return static_cast<float>(rounded_to_unorm(value, 65535));
    case Storage::unorm8:
      return static_cast<float>(rounded_to_unorm(value, 255));
  }
  return 0;
}

template <class T>
std::array<T, most_channels> sample(const Texture& texture, T u, T v, Filter filter,
                                    Weights weights) {
  const Neighbours<T> x = neighbours(u, texture.width, filter, weights);
  const Neighbours<T> y = neighbours(v, texture.height, filter, weights);
  const auto width = static_cast<std::size_t>(texture.width);
  const auto channels = static_cast<std::size_t>(texture.channels);
  std::array<T, most_channels> result{};
  for (std::size_t c = 0; c < channels; ++c) {
    const auto texel = [&](std::size_t i, std::size_t j) {
      return static_cast<T>(texture.texels[(j * width + i) * channels + c]);
    };
    const T upper = blend(texel(x.first, y.first), texel(x.second, y.first), x.weight);
    const T lower = blend(texel(x.first, y.second), texel(x.second, y.second), x.weight);
    result[c] = blend(upper, lower, y.weight);
  }
  return result;
}

template std::array<float, most_channels> sample(const Texture&, float, float, Filter, Weights);
template std::array<double, most_channels> sample(const Texture&, double, double, Filter, Weights);

}  // namespace gonio::lut
