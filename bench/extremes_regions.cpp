#include "bench/extremes_regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gonio::bench {
namespace {

using brdf::Direction;
using brdf::direction_from_degrees;
using MaybePair = std::optional<DirectionPair>;

constexpr double degree = std::numbers::pi / 180;

double azimuth(RandomSource& random) { return random.uniform(0, 360); }

/// From 80 degrees to 89.999.
double grazing_angle(RandomSource& random) { return 90 - random.magnitude(1e-3, 10); }

double ordinary_angle(RandomSource& random) { return random.uniform(0, 80); }

double any_angle(RandomSource& random) {
  switch (random.index(4)) {
    case 0:
      return grazing_angle(random);
    case 1:
      return random.magnitude(1e-8, 1);
    default:
      return ordinary_angle(random);
  }
}

Direction<double> any_direction(RandomSource& random) {
  return direction_from_degrees(any_angle(random), azimuth(random));
}

MaybePair above(const Direction<double>& wi, const Direction<double>& wo) {
  if (!(wi.z > 0 && wo.z > 0)) return std::nullopt;
  return DirectionPair{wi, wo};
}

/// wi mirrored about the half vector of slopes hx/hz = x and hy/hz = y.
Direction<double> mirrored_about_slopes(const Direction<double>& wi, double x, double y) {
  const double scale = 2 * (wi.x * x + wi.y * y + wi.z) / (x * x + y * y + 1);
  return {scale * x - wi.x, scale * y - wi.y, scale - wi.z};
}

MaybePair about_slope(const Direction<double>& wi, double slope, double phi) {
  return above(wi, mirrored_about_slopes(wi, slope * std::cos(phi), slope * std::sin(phi)));
}

MaybePair normal_incidence(RandomSource& random, const Reflectance& /*f*/) {
  return above({0, 0, 1}, any_direction(random));
}

MaybePair grazing_light(RandomSource& random, const Reflectance& /*f*/) {
  const double theta = grazing_angle(random);
  return above(direction_from_degrees(theta, azimuth(random)),
               direction_from_degrees(ordinary_angle(random), azimuth(random)));
}

MaybePair grazing_viewer(RandomSource& random, const Reflectance& f) {
  const MaybePair pair = grazing_light(random, f);
  return above(pair->wo, pair->wi);
}

/// Both grazing, with this azimuth between them, in degrees.
MaybePair grazing(RandomSource& random, double dphi) {
  const double phi = azimuth(random);
  const double theta = grazing_angle(random);
  return above(direction_from_degrees(theta, phi),
               direction_from_degrees(grazing_angle(random), phi + dphi));
}

/// 0 or a small angle of any order of magnitude, in degrees.
double small_angle(RandomSource& random) {
  return random.index(3) == 0 ? 0 : random.magnitude(1e-12, 5);
}

MaybePair grazing_same_side(RandomSource& random, const Reflectance& /*f*/) {
  return grazing(random, small_angle(random));
}

MaybePair grazing_opposite(RandomSource& random, const Reflectance& /*f*/) {
  return grazing(random, 180 + small_angle(random));
}

MaybePair grazing_any_azimuth(RandomSource& random, const Reflectance& /*f*/) {
  return grazing(random, azimuth(random));
}

MaybePair side_on(RandomSource& random, const Reflectance& /*f*/) {
  const double phi = azimuth(random);
  const double turn = random.coin() ? 90 : -90;
  const double theta = any_angle(random);
  return above(direction_from_degrees(theta, phi),
               direction_from_degrees(any_angle(random), phi + turn + random.magnitude(1e-14, 1)));
}

MaybePair mirror(RandomSource& random, const Reflectance& /*f*/) {
  const Direction<double> wi = any_direction(random);
  return above(wi, {-wi.x, -wi.y, wi.z});
}

/// The slope of the half vector at which the lobe is as good as dark, along one azimuth; 10 if it
/// is not dark anywhere.
double edge_of_lobe(const Reflectance& f, const Direction<double>& wi, double phi) {
  constexpr double darkness = 1e-12;
  const double centre = f(wi, {-wi.x, -wi.y, wi.z});
  const auto is_dark = [&](double slope) {
    const MaybePair pair = about_slope(wi, slope, phi);
    return !pair || f(pair->wi, pair->wo) < darkness * centre;
  };
  double lit = 1e-10;
  double dark = 10;
  if (!is_dark(dark)) return dark;
  while (dark > 1.05 * lit) {
    const double middle = std::sqrt(lit * dark);
    (is_dark(middle) ? dark : lit) = middle;
  }
  return dark;
}

MaybePair mirror_lobe(RandomSource& random, const Reflectance& f) {
  const Direction<double> wi = any_direction(random);
  const double phi = random.uniform(0, 2 * std::numbers::pi);
  return about_slope(wi, edge_of_lobe(f, wi, phi) * random.unit(), phi);
}

/// The viewer almost at a right angle to the mirror direction r: wo = cos r + sin t, t normal to r.
MaybePair edge_of_mirror(RandomSource& random, const Reflectance& /*f*/) {
  const Direction<double> wi = any_direction(random);
  const double theta = std::atan2(std::hypot(wi.x, wi.y), wi.z);
  const double phi = std::atan2(-wi.y, -wi.x);
  const Direction<double> down = brdf::direction_from_radians(theta + 90 * degree, phi);
  const Direction<double> side{-std::sin(phi), std::cos(phi), 0};
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  const double cosine = random.magnitude(1e-14, 0.3);
  const double sine = std::sqrt(1 - cosine * cosine);
  const auto along = [&](double r, double t, double s) {
    return cosine * r + sine * (std::cos(turn) * t + std::sin(turn) * s);
  };
  return above(
      wi, {along(-wi.x, down.x, side.x), along(-wi.y, down.y, side.y), along(wi.z, down.z, 0)});
}

MaybePair retro_reflection(RandomSource& random, const Reflectance& /*f*/) {
  const double theta = any_angle(random);
  const double phi = azimuth(random);
  const Direction<double> wi = direction_from_degrees(theta, phi);
  const double off_theta = std::clamp(theta + small_angle(random), 0.0, 89.999);
  return above(wi, direction_from_degrees(off_theta, phi + small_angle(random)));
}

MaybePair half_vector_near_pole(RandomSource& random, const Reflectance& /*f*/) {
  const Direction<double> wi = any_direction(random);
  return about_slope(wi, random.magnitude(1e-18, 1e-4), random.uniform(0, 2 * std::numbers::pi));
}

/// Both directions lie on a circle about the half vector, on opposite sides of it.
MaybePair half_vector_at_89(RandomSource& random, const Reflectance& /*f*/) {
  const double phi = azimuth(random);
  const Direction<double> h = direction_from_degrees(89, phi);
  const Direction<double> up = direction_from_degrees(1, phi + 180);
  const Direction<double> side = direction_from_degrees(90, phi + 90);
  // A circle of more than a degree dips below the horizon but for its points at the side.
  const double tilt = random.magnitude(1e-6, 1);
  const double radius = random.uniform(0, 89) * degree;
  const double c = std::cos(radius);
  const double s = std::sin(radius);
  const double a = tilt * std::min(1.0, 0.999 * std::sin(1 * degree) * c / (s + 1e-300));
  const double b = std::sqrt(1 - a * a);
  const auto component = [&](double sign, double hh, double uu, double ss) {
    return c * hh + sign * s * (a * uu + b * ss);
  };
  const auto on_circle = [&](double sign) {
    return Direction<double>{component(sign, h.x, up.x, side.x), component(sign, h.y, up.y, side.y),
                             component(sign, h.z, up.z, 0)};
  };
  return above(on_circle(1), on_circle(-1));
}

MaybePair ordinary(RandomSource& random, const Reflectance& /*f*/) {
  const double theta = ordinary_angle(random);
  const double phi = azimuth(random);
  return above(direction_from_degrees(theta, phi),
               direction_from_degrees(ordinary_angle(random), azimuth(random)));
}

/// The largest finite f_r over the viewers that peak_of() looks for.
double peak_over_viewers(const Reflectance& f, const Direction<double>& wi) {
  double peak = 0;
  const auto look_from = [&](const Direction<double>& wo) {
    const double value = f(wi, wo);
    if (std::isfinite(value)) peak = std::max(peak, value);
  };
  look_from({-wi.x, -wi.y, wi.z});
  look_from(wi);
  look_from({0, 0, 1});
  const double phi = std::atan2(wi.y, wi.x) / degree;
  for (const double theta : {15.0, 30.0, 45.0, 60.0, 75.0, 85.0, 89.0, 89.9, 89.99, 89.999}) {
    for (const double dphi : {0.0, 90.0, 180.0})
      look_from(direction_from_degrees(theta, phi + dphi));
  }
  // The streak of an anisotropic lobe: half vectors tilted along x or along y.
  constexpr double steepest = 30;
  for (double slope = 0.01; slope < steepest; slope *= 1.3) {
    for (const double signed_slope : {slope, -slope}) {
      look_from(mirrored_about_slopes(wi, signed_slope, 0));
      look_from(mirrored_about_slopes(wi, 0, signed_slope));
    }
  }
  return peak;
}

constexpr std::array all_regions{
    Region{"ordinary", "polar angles to 80 deg, any azimuth", ordinary},
    Region{"normal", "light exactly at the normal", normal_incidence},
    Region{"grazing light", "80 to 89.999 deg; the viewer ordinary", grazing_light},
    Region{"grazing viewer", "80 to 89.999 deg; the light ordinary", grazing_viewer},
    Region{"grazing, same", "both grazing, azimuths 0 to 5 deg apart", grazing_same_side},
    Region{"grazing, opposite", "both grazing, azimuths 180 to 185 deg apart", grazing_opposite},
    Region{"grazing, any", "both grazing, any azimuth", grazing_any_azimuth},
    Region{"side on", "azimuths 90 to 91 deg apart, any polar angles", side_on},
    Region{"mirror", "exactly the mirror direction: the half vector at the pole", mirror},
    Region{"pole", "half vector off the pole by slopes of 1e-18 to 1e-4", half_vector_near_pole},
    Region{"lobe", "about the mirror direction, to where the lobe is dark", mirror_lobe},
    Region{"edge", "cosine to the mirror direction from 1e-14 to 0.3", edge_of_mirror},
    Region{"retro", "light and viewer together, or up to 5 deg apart", retro_reflection},
    Region{"89 deg", "half vector at 89 deg", half_vector_at_89}};

}  // namespace

std::span<const Region> regions() { return all_regions; }

DirectionPair draw_pair(const Region& region, RandomSource& random, const Reflectance& f) {
  for (;;) {
    if (const MaybePair pair = region.draw(random, f)) return *pair;
  }
}

double peak_of(const Reflectance& f, const Direction<double>& wi) {
  const Direction<double> slanting = direction_from_degrees(45, 0);
  return std::max(peak_over_viewers(f, wi), slanting.z * peak_over_viewers(f, slanting));
}

}  // namespace gonio::bench
