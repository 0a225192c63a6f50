// Loops over many pixels, one for each of the published listings and its rivals, as bench/listings
// times them. All is float.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace gonio::bench {

/// The components of a unit vector at every pixel.
struct Vectors {
  std::vector<float> x, y, z;
};

/// The vectors at every pixel, in one common frame: normal, to the light, to the viewer, the last
/// two above the surface.
struct Pixels {
  Vectors n, l, v;

  std::size_t size() const { return n.x.size(); }
};

struct Kernel {
  std::string_view name;
  /// Writes the value at every pixel; `values` has as many.
  void (*evaluate)(const Pixels& pixels, std::span<float> values);
};

/// Ways to compute the same; the first is what the others are compared with.
struct KernelGroup {
  std::string_view name;
  std::span<const Kernel> kernels;
};

/// The groups `oren-nayar`, `phong` and `ward`, from listing_kernels.cpp compiled once without
/// vectorisation and once with it. The same groups and kernels in the same order.
std::span<const KernelGroup> scalar_kernels();
std::span<const KernelGroup> vectorised_kernels();

}  // namespace gonio::bench
