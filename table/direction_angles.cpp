#include "table/direction_angles.h"

#include <array>
#include <cmath>
#include <numbers>

namespace gonio::table {
namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

double rounded(double degrees) { return std::round(degrees * 1e9) / 1e9; }

bool is_written_as(const brdf::Direction<double>& d, const AnglesDeg& angles) {
  const brdf::Direction<double> made = brdf::direction_from_degrees(angles.theta, angles.phi);
  return made.x == d.x && made.y == d.y && made.z == d.z;
}

}  // namespace

AnglesDeg angles_of(const brdf::Direction<double>& d) {
  if (d.x == 0 && d.y == 0) return {d.z < 0 ? 180.0 : 0.0, 0};
  // A reader multiplies by radians_per_degree: dividing by it leaves one rounding of each.
  const AnglesDeg plain{std::atan2(std::hypot(d.x, d.y), d.z) / radians_per_degree,
                        std::atan2(d.y, d.x) / radians_per_degree};
  const double theta = rounded(plain.theta);
  const double phi = rounded(plain.phi);
  const std::array<AnglesDeg, 2> written{{{theta, phi}, {theta, phi + 360}}};
  if (is_written_as(d, written[0])) return written[0];
  // Azimuths may run from 0 to 360: the sine of 200 deg is not that of -160 to the last bit.
  if (phi < 0 && is_written_as(d, written[1])) return written[1];
  return plain;
}

}  // namespace gonio::table
