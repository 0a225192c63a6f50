// Random geometries for the published listings, and the models' values at the same vectors.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

#include "brdf/direction.h"
#include "brdf/listings.h"
#include "brdf/term.h"

namespace gonio::tests {

/// A pixel in float with the normal z, and the same vectors, no rounding apart, for the models.
struct ListingDraw {
  brdf::listings::Geometry at;
  brdf::Direction<double> wi, wo;
};

inline brdf::listings::Float3 in_float(const brdf::Direction<double>& w) {
  return {static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)};
}

inline brdf::Direction<double> in_double(const brdf::listings::Float3& w) {
  return {w.x, w.y, w.z};
}

inline ListingDraw with_normal_z(const brdf::Direction<double>& wi,
                                 const brdf::Direction<double>& wo) {
  const brdf::listings::Geometry at{{0, 0, 1}, in_float(wi), in_float(wo)};
  return {at, in_double(at.l), in_double(at.v)};
}

/// Directions with cosines of at least 0.05, and viewers near the mirror direction.
class ListingDraws {
 public:
  double uniform(double lowest, double highest) {
    return std::uniform_real_distribution<double>(lowest, highest)(generator_);
  }

  brdf::Direction<double> direction() {
    const double cosine = uniform(lowest_cosine, 1);
    const double phi = uniform(0, 2 * std::numbers::pi);
    return brdf::direction_from_radians(std::acos(cosine), phi);
  }

  ListingDraw anywhere() {
    const brdf::Direction<double> wi = direction();
    return with_normal_z(wi, direction());
  }

  /// Half vectors whose slopes are within three times these widths, evenly over the ellipse.
  ListingDraw within_lobe(double width_x, double width_y) {
    const brdf::Direction<double> wi = direction();
    const double radius = 3 * std::sqrt(uniform(0, 1));
    const double phi = uniform(0, 2 * std::numbers::pi);
    const double x = width_x * radius * std::cos(phi);
    const double y = width_y * radius * std::sin(phi);
    const double scale = 2 * (wi.x * x + wi.y * y + wi.z) / (x * x + y * y + 1);
    const brdf::Direction<double> wo{scale * x - wi.x, scale * y - wi.y, scale - wi.z};
    return wo.z >= lowest_cosine ? with_normal_z(wi, wo) : within_lobe(width_x, width_y);
  }

 private:
  static constexpr double lowest_cosine = 0.05;

  std::mt19937_64 generator_{2008};
};

/// f_r of the term T in 1/sr, in double.
template <brdf::Term T>
double f_r(const std::array<double, T::amplitudes.size()>& amplitudes,
           const std::array<double, T::shape.size()>& shape, const brdf::Direction<double>& wi,
           const brdf::Direction<double>& wo) {
  const auto coefficients = brdf::coefficients_of<T, double>(amplitudes);
  const auto basis = T::template basis<double, double>(shape, wi, wo);
  double sum = 0;
  for (std::size_t b = 0; b < basis.size(); ++b) sum += coefficients[b] * basis[b];
  return sum;
}

}  // namespace gonio::tests
