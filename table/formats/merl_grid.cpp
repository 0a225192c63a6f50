#include "table/formats/merl_grid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "table/formats/half_difference.h"

namespace gonio::table {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double same_direction = 1e-5 * pi / 180;

/// An angle among the bins of one coordinate.
struct AxisPlace {
  std::size_t bin;
  double moved;  // to the bin's lower edge, radians
};

/// The bin whose lower edge is `edge(bin)`; `position` counts bins, to the rounding that the edges
/// mend. An angle that is short of the next edge by no more than `tolerance` is in the next bin.
template <class Edge>
AxisPlace place(double position, std::size_t count, double angle, double tolerance,
                const Edge& edge) {
  const auto last = static_cast<double>(count - 1);
  const auto bin = static_cast<std::size_t>(position > 0 ? std::min(position, last) : 0.0);
  const double below = edge(bin + 1) - angle;
  const double most = std::min(tolerance, (edge(bin + 1) - edge(bin)) / 2);
  if (below > most) return {bin, std::abs(angle - edge(bin))};
  return {bin + 1, std::abs(below)};
}

AxisPlace place_theta_h(const MerlGrid& grid, double theta, double tolerance) {
  const std::size_t count = grid.theta_h_count;
  const double position = static_cast<double>(count) * std::sqrt(theta / (pi / 2));
  const AxisPlace found =
      place(position, count, theta, tolerance, [&](std::size_t k) { return grid.theta_h(k); });
  return {std::min(found.bin, count - 1), found.moved};
}

AxisPlace place_theta_d(const MerlGrid& grid, double theta) {
  const std::size_t count = grid.theta_d_count;
  const double position = static_cast<double>(count) * theta / (pi / 2);
  const AxisPlace found =
      place(position, count, theta, same_direction, [&](std::size_t k) { return grid.theta_d(k); });
  return {std::min(found.bin, count - 1), found.moved};
}

/// For `phi` in [-pi, pi]: by reciprocity half a turn more or less is the same.
AxisPlace place_phi_d(const MerlGrid& grid, double phi, double tolerance) {
  const std::size_t count = grid.phi_d_count;
  const double folded = phi < 0 ? phi + pi : phi;
  const double position = static_cast<double>(count) * folded / pi;
  const AxisPlace found =
      place(position, count, folded, tolerance, [&](std::size_t k) { return grid.phi_d(k); });
  return {found.bin % count, found.moved};
}

/// How much the half vector may turn while neither direction turns by more than `same_direction`:
/// the wider apart they are, the shorter it is.
double half_vector_tolerance(const HalfDifference& at) {
  return same_direction / std::max(std::cos(at.theta_d), same_direction);
}

/// The same of phi_d, where theta_d is not 0.
double phi_d_tolerance(const HalfDifference& at) {
  const double tolerance = same_direction / std::sin(at.theta_d);
  const double h_tolerance = half_vector_tolerance(at);
  return at.theta_h > h_tolerance ? tolerance + h_tolerance / std::sin(at.theta_h) : tolerance;
}

}  // namespace

double MerlGrid::theta_h(std::size_t k) const {
  const double part = static_cast<double>(k) / static_cast<double>(theta_h_count);
  return pi / 2 * part * part;
}

double MerlGrid::theta_d(std::size_t k) const {
  return pi / 2 * static_cast<double>(k) / static_cast<double>(theta_d_count);
}

double MerlGrid::phi_d(std::size_t k) const {
  return pi * static_cast<double>(k) / static_cast<double>(phi_d_count);
}

MerlPlace merl_place(const MerlGrid& grid, const brdf::Direction<double>& wi,
                     const brdf::Direction<double>& wo) {
  const HalfDifference at = half_difference(wi, wo, same_direction);
  const double h_tolerance = half_vector_tolerance(at);
  const AxisPlace theta_h = place_theta_h(grid, at.theta_h, h_tolerance);
  const AxisPlace theta_d = place_theta_d(grid, at.theta_d);
  const bool has_phi_d = at.theta_d > same_direction;
  const double tolerance = has_phi_d ? phi_d_tolerance(at) : pi;
  const AxisPlace phi_d = has_phi_d ? place_phi_d(grid, at.phi_d, tolerance) : AxisPlace{0, 0};
  return {.bin = (theta_h.bin * grid.theta_d_count + theta_d.bin) * grid.phi_d_count + phi_d.bin,
          .theta_h_bin = theta_h.bin,
          .theta_d_bin = theta_d.bin,
          .is_on_node = theta_h.moved <= h_tolerance && theta_d.moved <= same_direction &&
                        phi_d.moved <= tolerance,
          .has_phi_d = has_phi_d,
          .moved = std::max({theta_h.moved, theta_d.moved, std::sin(at.theta_d) * phi_d.moved}),
          .is_turned = std::sin(at.theta_h) * std::abs(at.phi_h) > h_tolerance};
}

double merl_weight(const MerlGrid& grid, std::size_t theta_h_bin, std::size_t theta_d_bin) {
  const double h0 = grid.theta_h(theta_h_bin);
  const double h1 = grid.theta_h(theta_h_bin + 1);
  const double d0 = grid.theta_d(theta_d_bin);
  const double d1 = grid.theta_d(theta_d_bin + 1);
  const double cosines = 2 * std::sin((h0 + h1) / 2) * std::sin((h1 - h0) / 2);
  const double squares = std::sin(d1 + d0) * std::sin(d1 - d0);
  return cosines * 2 * squares * grid.phi_d(1);
}

}  // namespace gonio::table
