// A reflectance as a table over incident zenith, exit zenith and relative azimuth, which is all
// that some formats have room for, and its linear interpolation.
//
// The relative azimuth is that of the exit direction from the incident one: 0 towards the light,
// pi in the mirror direction. The table is nested: each incident zenith has its own exit zeniths,
// each of these its own azimuths, dense where the lobe is. Reading it is linear in each of the
// three in turn, first along the azimuths. It covers azimuths 0 to pi; beyond, it is symmetric.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "material/comparison.h"

namespace gonio::exports {

/// The values at one incident and one exit zenith. At the pole there is one azimuth, 0.
struct AzimuthRow {
  double theta_o;              // radians
  std::vector<double> phi;     // radians, ascending from 0 to pi
  std::vector<double> values;  // f_r in 1/sr, [azimuth][channel]
};

/// The values at one incident zenith, with ascending exit zeniths.
struct IncidenceSlice {
  double theta_i;  // radians
  std::vector<AzimuthRow> rows;
};

struct RelativeAzimuthTable {
  std::size_t channel_count;
  std::vector<IncidenceSlice> slices;  // ascending
  /// The error that interpolation between incidences was allowed, as a share of the channel's
  /// largest f_r for the same light.
  double tolerance;
};

/// The largest zenith in a table, 89 degrees in radians: some models have a pole at 90.
double largest_tabulated_theta();

/// How many entries a channel has where azimuths beyond pi are written, too.
std::size_t full_circle_entries(const RelativeAzimuthTable& table);

/// f_r of every channel for theta_i, theta_o and relative azimuth in radians.
using RelativeReflectance = std::function<void(double, double, double, std::span<double>)>;

/// What an isotropic reflectance gives for the light at azimuth 0.
RelativeReflectance at_azimuth_zero(const material::Reflectance& reflectance);

/// The mean of a reflectance over all azimuths of the light: of all reflectances without a tangent
/// the nearest in the mean square. By `count` evenly spaced azimuths in a half turn, after which
/// the reflectances of this project repeat.
RelativeReflectance azimuth_mean(const material::Reflectance& reflectance,
                                 std::size_t channel_count, std::size_t count);

/// The table whose interpolation comes as near to the reflectance as `most_entries` (at least
/// 2500) per channel allow. Angles are multiples of 1e-6 rad, values those at the angles as
/// written.
RelativeAzimuthTable tabulate(const RelativeReflectance& reflectance, std::size_t channel_count,
                              std::size_t most_entries);

/// The interpolated f_r of every channel. Beyond the largest zeniths their values are held; 0 below
/// the horizon.
void interpolate(const RelativeAzimuthTable& table, const brdf::Direction<double>& wi,
                 const brdf::Direction<double>& wo, std::span<double> f_r);

}  // namespace gonio::exports
