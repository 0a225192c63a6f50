#include "table/masks.h"

#include <cmath>
#include <numbers>

namespace gonio::table {
namespace {

/// |a - b|^2 of unit vectors: 4 sin^2(angle / 2), exact for small angles.
double squared_distance(const brdf::Direction<double>& a, const brdf::Direction<double>& b) {
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  const double z = a.z - b.z;
  return x * x + y * y + z * z;
}

double squared_distance_at(double degrees) {
  const double chord = 2 * std::sin(degrees * std::numbers::pi / 360);
  return chord * chord;
}

template <class Other>
std::size_t mask_near(SampleTable& table, double degrees, MaskReason reason, const Other& other) {
  const double limit = squared_distance_at(degrees);
  std::size_t count = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.mask[i] != MaskReason::none) continue;
    if (squared_distance(table.wo[i], other(i)) >= limit) continue;
    table.mask[i] = reason;
    ++count;
  }
  return count;
}

}  // namespace

std::size_t mask_retro(SampleTable& table, double degrees) {
  return mask_near(table, degrees, MaskReason::retro, [&](std::size_t i) { return table.wi[i]; });
}

std::size_t mask_blind_spot(SampleTable& table, const brdf::Direction<double>& wo, double degrees) {
  return mask_near(table, degrees, MaskReason::blind_spot, [&](std::size_t) { return wo; });
}

}  // namespace gonio::table
