// Phong's exponents, Ward's roughness and Ashikhmin and Shirley's exponents: the closed form by
// which one becomes the other, and the conventions in which Phong's amplitudes are given.
//
// All lobes here are, or are near, a power of the cosine between the normal and the half vector;
// its exponent is what they are converted through:
//
//   blinn-phong, ashikhmin-shirley   their own exponent
//   phong    4 times its exponent: an angle about the mirror direction is twice that of the half
//   vector.
//            Across the plane of incidence it is 4 cos^2(theta) exponent: near normal incidence
//            only
//   ward*    2 / alpha^2 - 2: exp(-tan^2/alpha^2) falls off as (n.h)^(2/alpha^2) near the peak; the
//   2
//            makes exponent 0 roughness 1 (Walter et al., Microfacet Models for Refraction, 2007)
//
// Amplitudes are converted so that f_r at normal incidence, with the viewer there too, is kept.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/parameter.h"
#include "material/material.h"

namespace gonio::material {

/// How the amplitude of a Phong or Blinn-Phong lobe of exponent n is given:
///   raw         f_r = ks cos^n                   ks in 1/sr
///   normalised  f_r = k (n + 2)/(2 pi) cos^n     (Lafortune & Willems 1994; Ngan et al. 2005)
///   classic     light leaving = Ks cos^n with no cosine of the incidence, as shaders and Wavefront
///               .mtl have it: f_r = Ks cos^n / (pi cos_i), which no lobe here is; at normal
///               incidence ks = Ks / pi
enum class Amplitude { raw, normalised, classic };
std::string_view name(Amplitude amplitude);
/// Throws std::invalid_argument that lists the conventions.
Amplitude amplitude_from_name(std::string_view name);

/// ks in 1/sr of the amplitude given in a convention; for the exponent at least 0.
double raw_amplitude(Amplitude convention, double value, double exponent);
/// The inverse.
double amplitude_in(Amplitude convention, double ks, double exponent);

/// The specular terms that have a closed form, phong first.
std::span<const std::string_view> convertible_terms();

/// The descriptors of a convertible term's exponent or roughness, and of its amplitude. Throw
/// std::invalid_argument for other terms.
const brdf::Parameter& shape_parameter(std::string_view term);
const brdf::Parameter& amplitude_parameter(std::string_view term);

/// A lobe of one of these terms: `shape` is its exponent or alpha, `amplitudes` its ks, rho_s or
/// Rs, one per channel.
struct Lobe {
  std::string term;
  double shape;
  std::vector<double> amplitudes;
};

/// The exponent of the half vector's cosine that the lobe's shape stands for. May be below 0 for a
/// roughness above 1. Throws std::invalid_argument for a term without closed form.
double half_vector_exponent(std::string_view term, double shape);
/// The inverse. Throws also for an exponent of -2 or less, and below 0 where the term has an
/// exponent.
double shape_of_exponent(std::string_view term, double half_vector_exponent);

/// f_r in 1/sr at normal incidence of the lobe with the amplitude 1.
double peak_at_normal(std::string_view term, double shape);

/// The lobe of the term `to` by the closed form. Throws std::invalid_argument where it does not
/// exist: a roughness above 1 as an exponent, a shape or an amplitude beyond the term's bounds.
Lobe closed_form(const Lobe& lobe, std::string_view to);

/// Lambert's diffuse and the lobe as a material; rho_d one per channel.
Material material_of(const Lobe& lobe, std::span<const double> rho_d,
                     std::span<const std::string> channels);

}  // namespace gonio::material
