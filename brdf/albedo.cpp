#include "brdf/albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "brdf/adaptive_quadrature.h"

namespace gonio::brdf {
namespace {

using std::numbers::pi;

constexpr std::size_t most_radial_intervals = 200;
constexpr std::size_t most_azimuth_intervals = 1000;

/// The half vectors of one azimuth psi, from the normal (t = 0) to where wo meets the horizon.
///
/// With h = (t cos psi, t sin psi, 1) and wo = 2 (h.wi) h / (h.h) - wi, the cosine
/// wo.z = wi.z (1 + 2 t s / wi.z - t^2) / (1 + t^2), where s = wi.x cos psi + wi.y sin psi, is
/// positive between the roots -1/end and end, end = (s + sqrt(s^2 + wi.z^2)) / wi.z.
class AzimuthOfHalfVectors {
 public:
  AzimuthOfHalfVectors(const Direction<double>& wi, double psi, double decades_per_piece)
      : wi_(wi),
        decades_per_piece_(decades_per_piece),
        cos_psi_(std::cos(psi)),
        sin_psi_(std::sin(psi)),
        s_(wi.x * cos_psi_ + wi.y * sin_psi_) {
    const double root = std::hypot(s_, wi.z);
    end_ = s_ > 0 ? (s_ + root) / wi.z : wi.z / (root - s_);
    start_ = std::min(1e-8, 1e-3 * end_);
    decades_ = std::log10(end_ / 2 / start_);
  }

  struct Point {
    Direction<double> wo;
    /// cos(theta_o) dwo / (dpsi dx) for the variable x below.
    double measure;
  };

  /// The variable of integration x runs over three pieces: from -1 to 0 t is proportional to x + 1,
  /// from 0 to D its decimal logarithm is, and from D to D + 1 1 - t/end is the square of a linear
  /// function, which takes square roots of the cosine at the horizon for what they are.
  std::vector<double> breaks() const {
    const double pieces = std::ceil(decades_ / decades_per_piece_);
    std::vector<double> result{-1};
    for (double k = 0; k <= pieces; ++k) result.push_back(decades_ * k / pieces);
    result.push_back(decades_ + 1);
    return result;
  }

  Point at(double x) const {
    double t = 0;
    double rest = 0;  // 1 - t / end
    double dt_dx = 0;
    if (x < 0) {
      t = start_ * (1 + x);
      rest = 1 - t / end_;
      dt_dx = start_;
    } else if (x < decades_) {
      t = start_ * std::pow(10, x);
      rest = 1 - t / end_;
      dt_dx = t * std::numbers::ln10;
    } else {
      const double root = (decades_ + 1 - x) * std::numbers::sqrt2 / 2;
      rest = root * root;
      t = end_ * (1 - rest);
      dt_dx = end_ * root * std::numbers::sqrt2;
    }
    Point point = at_slope(t, rest);
    point.measure *= dt_dx;
    return point;
  }

  double end() const { return end_; }

  /// The same at the slope t, rest = 1 - t / end(); the measure is by t.
  Point at_slope(double t, double rest) const {
    const double hh = 1 + t * t;
    const double h_wi = wi_.z + t * s_;
    const double scale = 2 * h_wi / hh;
    const double cosine = wi_.z * end_ * rest * (t + 1 / end_) / hh;
    const Direction<double> wo{scale * t * cos_psi_ - wi_.x, scale * t * sin_psi_ - wi_.y, cosine};
    // dwo = 4 (h.wi) dh for unit h, and dh = t dt dpsi / (1 + t^2)^(3/2).
    return {wo, cosine * 4 * h_wi / (hh * hh) * t};
  }

 private:
  Direction<double> wi_;
  double decades_per_piece_;
  double cos_psi_, sin_psi_;
  double s_;
  double end_;
  double start_;    // where the logarithmic piece begins
  double decades_;  // its length
};

/// How finely the integrals are divided before anything is known of the model.
struct FirstDivision {
  double decades_per_piece;  // of t
  double azimuth_step;       // pi or a part of it
};

/// A jump or a kink can hide between the points of a coarse division; no lobe can, as it is a
/// decade of t wide.
FirstDivision first_division(double tolerance) {
  if (tolerance > 1e-4) return {2, pi / 2};
  return {1, pi / 4};
}

/// The azimuths, from that of wi on, that divide the integral over psi: steps, and ever smaller
/// ones towards those across the plane of incidence. Within wi.z of them the horizon draws near,
/// and a lobe about the mirror direction is as narrow.
std::vector<double> azimuth_breaks(double cos_i, bool whole_turn, double step) {
  std::vector<double> half;
  for (double psi = 0; psi <= pi; psi += step) half.push_back(psi);
  for (double offset = cos_i; offset < 0.3; offset *= 10) {
    half.push_back(pi / 2 - offset);
    half.push_back(pi / 2 + offset);
  }
  std::sort(half.begin(), half.end());
  if (!whole_turn) return half;
  std::vector<double> whole = half;
  for (std::size_t k = 1; k < half.size(); ++k) whole.push_back(half[k] + pi);
  return whole;
}

void check(double theta_i, double phi_i, double tolerance) {
  if (!(theta_i >= 0 && theta_i < pi / 2)) {
    throw std::invalid_argument(
        "albedo: the angle of incidence has to be from 0 to less than 90 degrees");
  }
  if (!std::isfinite(phi_i)) {
    throw std::invalid_argument("albedo: the azimuth of incidence has to be a finite number");
  }
  if (!(tolerance >= 1e-10 && tolerance <= 0.1)) {
    throw std::invalid_argument("albedo: the tolerance has to be from 1e-10 to 0.1");
  }
}

double saturated(double value) {
  constexpr double largest = std::numeric_limits<double>::max();
  return value < largest ? value : largest;
}

}  // namespace

Albedo basis_albedo(const Model& model, std::span<const double> shape, double theta_i, double phi_i,
                    double tolerance) {
  check(theta_i, phi_i, tolerance);
  const std::size_t count = model.basis_size();
  const Direction<double> wi = direction_from_radians(theta_i, phi_i);
  const FirstDivision division = first_division(tolerance);
  std::vector<double> basis(count);

  // Per azimuth: the integral over t of each basis function, then the error of each.
  const auto over_t = [&](double psi, std::span<double> results) {
    const AzimuthOfHalfVectors azimuth(wi, phi_i + psi, division.decades_per_piece);
    const auto integrand = [&](double x, std::span<double> values) {
      const AzimuthOfHalfVectors::Point point = azimuth.at(x);
      model.basis(shape, wi, point.wo, basis);
      for (std::size_t b = 0; b < count; ++b) values[b] = basis[b] * point.measure;
    };
    const Integrals radial =
        integrate(integrand, count, azimuth.breaks(), {tolerance / 10, {}, most_radial_intervals});
    std::copy(radial.values.begin(), radial.values.end(), results.begin());
    std::copy(radial.errors.begin(), radial.errors.end(), results.begin() + std::ptrdiff_t(count));
  };

  // An isotropic material is the same on both sides of the plane of incidence.
  const bool whole_turn = model.is_anisotropic();
  std::vector<double> any_error(2 * count);
  std::fill(any_error.begin() + std::ptrdiff_t(count), any_error.end(),
            std::numeric_limits<double>::infinity());
  const Integrals sum =
      integrate(over_t, 2 * count, azimuth_breaks(wi.z, whole_turn, division.azimuth_step),
                {0.9 * tolerance, any_error, most_azimuth_intervals});
  Albedo result;
  for (std::size_t b = 0; b < count; ++b) {
    const double sides = whole_turn ? 1 : 2;
    result.values.push_back(saturated(sides * sum.values[b]));
    result.errors.push_back(saturated(sides * (sum.errors[b] + sum.values[count + b])));
  }
  return result;
}

std::vector<double> rough_basis_albedo(const Model& model, std::span<const double> shape,
                                       double theta_i, double phi_i) {
  check(theta_i, phi_i, albedo_tolerance);
  constexpr double steps_per_decade = 6;
  const int azimuths = model.is_anisotropic() ? 48 : 16;
  constexpr double least_slope = 1e-5;
  const Direction<double> wi = direction_from_radians(theta_i, phi_i);
  const double ratio = std::pow(10, 1 / steps_per_decade);
  std::vector<double> basis(model.basis_size());
  std::vector<double> sums(model.basis_size());
  for (int k = 0; k < azimuths; ++k) {
    const AzimuthOfHalfVectors azimuth(wi, phi_i + 2 * std::numbers::pi * (k + 0.5) / azimuths, 1);
    for (double t = least_slope; t < azimuth.end(); t *= ratio) {
      const AzimuthOfHalfVectors::Point point = azimuth.at_slope(t, 1 - t / azimuth.end());
      model.basis(shape, wi, point.wo, basis);
      for (std::size_t b = 0; b < basis.size(); ++b) sums[b] += basis[b] * point.measure * t;
    }
  }
  // dpsi, and dt = t ln(ratio).
  for (double& sum : sums) sum = saturated(sum * 2 * std::numbers::pi / azimuths * std::log(ratio));
  return sums;
}

Albedo albedo(const BoundModel& model, double theta_i, double phi_i, double tolerance) {
  const Albedo basis = basis_albedo(model.model(), model.shape(), theta_i, phi_i, tolerance);
  Albedo result;
  for (std::size_t c = 0; c < model.channel_count(); ++c) {
    double value = 0;
    double error = 0;
    for (std::size_t b = 0; b < basis.values.size(); ++b) {
      const double coefficient = model.coefficients(c)[b];
      if (coefficient == 0) continue;
      value += coefficient * basis.values[b];
      error += std::abs(coefficient) * basis.errors[b];
    }
    result.values.push_back(saturated(value));
    result.errors.push_back(saturated(error));
  }
  return result;
}

}  // namespace gonio::brdf
