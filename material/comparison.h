// One material standing in for another: on which directions they are compared, and how far they are
// apart.
//
// The directions are stated incidence angles and, for each, viewing directions that show the lobe
// (brdf/lobe_directions.h). What is compared is the reflected radiance f_r cos_i for a light of
// unit irradiance, which a picture shows.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "brdf/bound_model.h"
#include "table/sample_table.h"

namespace gonio::material {

/// Writes f_r of every channel in 1/sr for a pair of unit vectors wi, wo.
using Reflectance = std::function<void(const brdf::Direction<double>&,
                                       const brdf::Direction<double>&, std::span<double>)>;

/// The reflectance of a model with its values, which must outlive it.
Reflectance reflectance_of(const brdf::BoundModel& model);

/// For which light two materials are compared, and with which viewers.
struct Incidence {
  /// Polar angles in degrees, each at least 0 and at most largest_compared_theta_deg.
  std::vector<double> theta_deg = {0, 15, 30, 45, 60, 75};
  /// Azimuths in degrees: one for isotropic materials, several for others.
  std::vector<double> phi_deg = {0};
  /// Viewers on both sides of the plane of incidence, and not on one side for both: needed where a
  /// material has a tangent.
  bool both_sides = false;
};

/// Four azimuths in a quarter turn and viewers on both sides if the model has a tangent.
Incidence default_incidence(const brdf::Model& model);

/// The largest polar angle of light and viewer at which the radiances are compared, in degrees, as
/// a fit does.
inline constexpr double largest_compared_theta_deg = 80;

/// The pairs of directions on which materials are compared, with their solid angles as weights, and
/// the values of a reflectance on them. Throws std::invalid_argument for an angle out of range.
table::SampleTable sample(const Reflectance& reflectance, std::span<const std::string> channels,
                          const Incidence& incidence);

/// Where the largest difference is.
struct WorstPlace {
  double theta_i_deg = 0;
  double theta_o_deg = 0;
  std::string channel;
};

/// How far a stand-in is from a material; all over the same directions, viewers up to 80 deg. The
/// reflected radiance is f_r cos_i.
struct Difference {
  /// The largest difference of reflected radiance in any channel, per largest radiance of the
  /// material in its brightest one.
  double peak = 0;
  WorstPlace where = {};
  /// The root mean square of the difference, weighted by solid angle, per root mean square of the
  /// material's radiance; over all channels.
  double rms = 0;
  /// The largest difference of directional albedo in any channel, signed: the stand-in's less the
  /// material's. By sums over the directions, good to 2e-3 of the albedo.
  double albedo = 0;
};

/// How many times as wide one way as the other the most stretched lobe is; 1 without a tangent.
/// From 6 on the directions begin to miss it: at 20 the differences are told to a third, of albedo
/// less.
double largest_anisotropy(const brdf::BoundModel& model);

/// `material` as sample() gives it; the stand-in is evaluated on its directions. All 0 where both
/// are black, and infinite where only the material is.
Difference difference(const table::SampleTable& material, const Reflectance& stand_in);

}  // namespace gonio::material
