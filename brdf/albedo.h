// Directional albedo: the share of the light from one direction that a material reflects.
//
// rho(wi) = integral of f_r(wi, wo) cos(theta_o) over the directions wo above the horizon (the
// directional-hemispherical reflectance of Nicodemus et al. 1977). Over 1 more light leaves than
// arrives, which no material does and several models do at grazing incidence.
//
// The integral is taken over the half vector, in polar coordinates of its slopes: azimuth psi and
// t = tan of its angle from the normal, logarithmic towards t = 0, the mirror direction. There a
// lobe has the same extent whatever its width, a lobe stretched in any direction is a smooth
// function of psi once t is integrated out, and the horizon is the end of the range of t in closed
// form. So nothing is asked of the model but its values.
//
// Both integrals, t within psi, are adaptive (adaptive_quadrature.h): they end when the difference
// of Kronrod's and Gauss's rules over all intervals is within the tolerance, for every function.
// Kinks are found by halving. A jump may be missed in part: Phong's exponent 0 is right to 2e-5.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "brdf/bound_model.h"
#include "brdf/model.h"

namespace gonio::brdf {

/// Directional albedos, with an upper estimate of the error of each.
struct Albedo {
  std::vector<double> values;
  std::vector<double> errors;
};

/// The relative tolerance of the albedos unless another is given.
inline constexpr double albedo_tolerance = 1e-6;

/// The albedo of each basis function of the model with the given shape (as in model.shape()), for
/// light from the polar angle `theta_i` and azimuth `phi_i`, in radians. The errors are at most
/// `tolerance` times the values; more where even 1000 intervals of psi do not reach that. Throws
/// std::invalid_argument unless 0 <= theta_i < pi/2, phi_i is finite and 1e-10 <= tolerance <= 0.1.
Albedo basis_albedo(const Model& model, std::span<const double> shape, double theta_i, double phi_i,
                    double tolerance = albedo_tolerance);

/// The same to some 20 % for lobes whose widths differ by less than 10 between directions, at a
/// small part of the cost: to find out whether it is worth a closer look. Throws as above.
std::vector<double> rough_basis_albedo(const Model& model, std::span<const double> shape,
                                       double theta_i, double phi_i);

/// The albedo of each channel of a material; the rest as above.
Albedo albedo(const BoundModel& model, double theta_i, double phi_i,
              double tolerance = albedo_tolerance);

}  // namespace gonio::brdf
