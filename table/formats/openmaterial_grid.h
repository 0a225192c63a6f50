// Directions by incident zenith, exit zenith and relative azimuth, nested: each incident zenith has
// its own exit zeniths, each of these its own azimuths.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "brdf/direction.h"

namespace gonio::table {

/// In radians; phi is that of wo from wi.
struct RelativeAngles {
  double theta_i;
  double theta_o;
  double phi;

  bool operator==(const RelativeAngles&) const = default;
};

/// A sample and what it counts.
struct GridNode {
  std::size_t sample;
  double share;
};

/// The samples that count for a pair of directions; none where the grid does not reach.
struct GridNodes {
  std::array<GridNode, 8> nodes;
  std::size_t count = 0;
};

class NestedGrid {
 public:
  /// Of the `samples` among all `angles`; no two of them have the same angles.
  NestedGrid(std::span<const RelativeAngles> angles, std::vector<std::size_t> samples);

  /// Linear in azimuth, then exit zenith, then incident zenith; shares add up to 1. Up to 1e-6 rad
  /// beyond the outer nodes theirs are held: files round their angles.
  GridNodes nodes_for(const brdf::Direction<double>& wi, const brdf::Direction<double>& wo) const;

  /// The solid angle of wi times that of wo for each of `count` samples, 0 for one that is not in
  /// the grid. Empty where the exit directions of an incident zenith form no grid.
  std::vector<double> solid_angles(std::size_t count) const;

 private:
  /// The azimuths at one incident and exit zenith: nodes from `first` to before `last`.
  struct Ring {
    std::size_t first, last;
    bool is_mirrored;  // 0 to pi, for both sides
    bool is_closed;    // goes on from the last azimuth to the first
  };
  /// What a node of the coarser axis counts.
  struct Share {
    std::size_t node;
    double share;
  };
  struct Shares {
    std::array<Share, 2> parts;
    std::size_t count = 0;
  };

  static Shares shares(std::span<const double> nodes, double at, double tolerance);
  Shares azimuth_shares(std::size_t ring, bool is_any_azimuth, double phi) const;
  Ring ring(std::size_t first, std::size_t last) const;
  std::span<const double> azimuths(const Ring& ring) const {
    return std::span(phi_).subspan(ring.first, ring.last - ring.first);
  }
  std::vector<double> azimuth_widths(const Ring& ring) const;
  std::vector<std::vector<double>> slice_widths(std::size_t slice) const;
  bool has_exit_grids() const;
  bool is_exit_grid(std::size_t slice) const;

  std::vector<double> theta_i_;
  std::vector<std::size_t> first_ring_;  // of each incident zenith, and the end
  std::vector<double> theta_o_;          // of each ring
  std::vector<Ring> rings_;
  std::vector<double> phi_;           // of each node
  std::vector<std::size_t> samples_;  // of each node
};

}  // namespace gonio::table
