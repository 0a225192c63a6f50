// A texture as a GPU holds it, and its sampling as a GPU does it.
//
// Texel (x, y) has its centre at u = (x + 1/2) / width, v = (y + 1/2) / height, as in Direct3D,
// Vulkan and OpenGL; beyond the centres of the outermost texels the addressing clamps. A table of
// one dimension is a texture of height 1.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace gonio::lut {

/// What a texel's channel is stored as: 32-bit or 16-bit float, or an integer of 16 or 8 bits that
/// stands for 0..1.
enum class Storage { r32f, r16f, unorm16, unorm8 };

enum class Filter { nearest, linear };

/// The weights of the linear filter: as T holds them, or rounded to 1/256 as GPUs do.
enum class Weights { exact, quantised };

inline constexpr std::array all_storages{Storage::r32f, Storage::r16f, Storage::unorm16,
                                         Storage::unorm8};
inline constexpr std::array all_filters{Filter::nearest, Filter::linear};

/// "r32f", "r16f", "unorm16", "unorm8"
std::string_view name_of(Storage storage);
/// "nearest", "linear"
std::string_view name_of(Filter filter);
std::size_t bytes_per_channel(Storage storage);

/// No table has more.
inline constexpr int most_channels = 2;

struct Texture {
  int width = 0;
  int height = 1;
  int channels = 1;  // 1 or 2
  Storage storage = Storage::r32f;
  /// [y][x][channel], as stored() gives them: 0..1 for unorm16 and unorm8.
  std::vector<float> texels;
};

std::size_t bytes_of(const Texture& texture);

/// The nearest number that the storage holds: r16f rounds to nearest even and saturates at 65504,
/// r32f saturates, the others cut to 0..1 and round to multiples of 1/65535 and 1/255.
float stored(double value, Storage storage);

/// The texture at (u, v), any finite ones; channels beyond the texture's are 0. T is float, which
/// computes as a GPU does (position, weight and blend in float), or double.
template <class T>
std::array<T, most_channels> sample(const Texture& texture, T u, T v, Filter filter,
                                    Weights weights = Weights::exact);

}  // namespace gonio::lut
