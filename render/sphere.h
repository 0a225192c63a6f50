// A lit sphere of one material, seen orthographically.
//
// The camera's frame: x to the right, y up, z from the sphere to the viewer, who is at infinity: wo
// is z everywhere. Where the normal is n, the tangent t = up x n runs along the parallels, to the
// right in the middle of the picture, and the bitangent n x t along the meridians, towards the
// upper pole: alpha_x is the roughness along the parallels. At the two poles, on the rim, t is x.
//
// The radiance of a point is the sum over the lights of E f_r cos_i, E the irradiance of a plane
// that faces the light: with the E = pi of all lights here, a white Lambert surface that faces its
// light has radiance 1.
#pragma once

#include <span>
#include <vector>

#include "brdf/direction.h"
#include "render/image.h"
#include "render/reflectance.h"

namespace gonio::render {

inline constexpr int largest_sphere = 4096;
inline constexpr int most_samples = 64;

/// The radius of the sphere over half the width of its picture.
inline constexpr double sphere_radius = 0.94;

struct SphereView {
  int size = 256;   // width and height in pixels, 1 to largest_sphere
  int samples = 4;  // across a pixel and down, 1 to most_samples; a pixel is the mean of them
  /// Unit vectors towards the lights, in the camera's frame; at least one.
  std::vector<brdf::Direction<double>> lights{brdf::direction_from_degrees(40, 120)};
  /// The angle from the parallel to the material's tangent, in radians, counted about the normal.
  double turn = 0;
};

/// Memory is that of the picture, three times, and a constant, whatever the samples. Throws
/// std::invalid_argument if the view is outside what is said above, and as `reflectance` does.
Image render_sphere(const Reflectance& reflectance, const SphereView& view);

}  // namespace gonio::render
