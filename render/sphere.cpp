#include "render/sphere.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace gonio::render {
namespace {

using Direction = brdf::Direction<double>;
using Pair = brdf::DirectionPair<float>;

/// Pairs of directions that are evaluated together, at least: the pixels of a batch are whole.
constexpr std::size_t batch_size = std::size_t{1} << 20;

constexpr double irradiance = std::numbers::pi;
constexpr Direction to_viewer{0, 0, 1};

void check(const SphereView& view) {
  if (view.size < 1 || view.size > largest_sphere) {
    throw std::invalid_argument(
        fmt::format("a picture of {} pixels: expected 1 to {}", view.size, largest_sphere));
  }
  if (view.samples < 1 || view.samples > most_samples) {
    throw std::invalid_argument(
        fmt::format("{} samples across a pixel: expected 1 to {}", view.samples, most_samples));
  }
  if (view.lights.empty()) throw std::invalid_argument("a sphere needs a light");
}

double dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// The material's axes at a point of the sphere, in the camera's frame.
struct Frame {
  Direction tangent, bitangent, normal;
};

Frame frame_at(const Direction& n, double turn) {
  const double length = std::hypot(n.z, n.x);
  const Direction t = length > 0 ? Direction{n.z / length, 0, -n.x / length} : Direction{1, 0, 0};
  const Direction b{n.y * t.z, n.z * t.x - n.x * t.z, -n.y * t.x};
  const double cos_turn = std::cos(turn);
  const double sin_turn = std::sin(turn);
  return {{cos_turn * t.x + sin_turn * b.x, sin_turn * b.y, cos_turn * t.z + sin_turn * b.z},
          {cos_turn * b.x - sin_turn * t.x, cos_turn * b.y, cos_turn * b.z - sin_turn * t.z},
          n};
}

brdf::Direction<float> in_frame(const Direction& direction, const Frame& frame) {
  return {float(dot(direction, frame.tangent)), float(dot(direction, frame.bitangent)),
          float(dot(direction, frame.normal))};
}

/// The samples of some pixels that need f_r, and the pixel of each.
struct Batch {
  std::vector<Pair> pairs;
  std::vector<std::size_t> pixels;
};

/// The normal where a sample is seen, or none beside the sphere. (x, y) are in pixels from the top
/// left corner.
std::optional<Direction> normal_at(double x, double y, int size) {
  const double scale = 2 / (size * sphere_radius);
  const Direction n{(x - 0.5 * size) * scale, (0.5 * size - y) * scale, 0};
  const double squared = n.x * n.x + n.y * n.y;
  if (squared >= 1) return std::nullopt;
  return Direction{n.x, n.y, std::sqrt(1 - squared)};
}

/// Adds what the lights make seen at a point to the batch.
void add_sample(const SphereView& view, const Direction& normal, std::size_t pixel, Batch& batch) {
  const Frame frame = frame_at(normal, view.turn);
  const brdf::Direction<float> wo = in_frame(to_viewer, frame);
  for (const Direction& light : view.lights) {
    const brdf::Direction<float> wi = in_frame(light, frame);
    if (wi.z <= 0 || wo.z <= 0) continue;
    batch.pairs.push_back({wi, wo});
    batch.pixels.push_back(pixel);
  }
}

/// Adds the samples of a pixel to the batch; the share of it that is covered.
double add_pixel(const SphereView& view, std::size_t pixel, Batch& batch) {
  const std::size_t x = pixel % std::size_t(view.size);
  const std::size_t y = pixel / std::size_t(view.size);
  int covered = 0;
  for (int down = 0; down < view.samples; ++down) {
    for (int across = 0; across < view.samples; ++across) {
      const auto normal = normal_at(double(x) + (across + 0.5) / view.samples,
                                    double(y) + (down + 0.5) / view.samples, view.size);
      if (!normal) continue;
      ++covered;
      add_sample(view, *normal, pixel, batch);
    }
  }
  return double(covered) / (view.samples * view.samples);
}

using Radiance = std::array<double, 3>;

/// Adds E f_r cos_i of each pair to the radiance of its pixel, as a share of the pixel's samples.
void add_radiance(const Reflectance& reflectance, const Batch& batch, double share,
                  std::vector<Radiance>& radiance) {
  std::vector<Rgb> f_r(batch.pairs.size());
  reflectance(batch.pairs, f_r);
  for (std::size_t i = 0; i < f_r.size(); ++i) {
    const double cos_i = batch.pairs[i].wi.z;
    for (std::size_t c = 0; c < 3; ++c) {
      radiance[batch.pixels[i]][c] += share * irradiance * cos_i * f_r[i][c];
    }
  }
}

}  // namespace

Image render_sphere(const Reflectance& reflectance, const SphereView& view) {
  check(view);
  const std::size_t count = std::size_t(view.size) * std::size_t(view.size);
  Image image{view.size, view.size, std::vector<Rgba>(count)};
  std::vector<Radiance> radiance(count);
  const double share = 1.0 / (view.samples * view.samples);
  Batch batch;
  for (std::size_t pixel = 0; pixel < count; ++pixel) {
    image.pixels[pixel][3] = float(add_pixel(view, pixel, batch));
    if (batch.pairs.size() < batch_size && pixel + 1 < count) continue;
    if (!batch.pairs.empty()) add_radiance(reflectance, batch, share, radiance);
    batch.pairs.clear();
    batch.pixels.clear();
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) image.pixels[i][c] = saturated(radiance[i][c]);
  }
  return image;
}

}  // namespace gonio::render
