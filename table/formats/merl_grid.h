// The bins of a MERL file (merl.h): a grid of Rusinkiewicz's coordinates (half_difference.h) for an
// isotropic material. Bins are finer in theta_h towards the highlight's centre, and phi_d covers
// half a turn, for reciprocity gives the other half.
#pragma once

#include <cstddef>

#include "brdf/direction.h"

namespace gonio::table {

/// The grid of a file. A bin's node is its lower edge in each coordinate.
struct MerlGrid {
  std::size_t theta_h_count = 90, theta_d_count = 90, phi_d_count = 180;

  /// At most as large as the bytes of a file that holds them.
  std::size_t bins() const { return theta_h_count * theta_d_count * phi_d_count; }
  /// Lower edges of bin k in radians: theta_h is (pi/2) (k/count)^2, the others are uniform.
  double theta_h(std::size_t k) const;
  double theta_d(std::size_t k) const;
  double phi_d(std::size_t k) const;
};

/// Where a pair of directions falls in a grid.
struct MerlPlace {
  std::size_t bin;  // in the order of the file
  std::size_t theta_h_bin, theta_d_bin;
  bool is_on_node;  // the pair is that of the bin's node
  bool has_phi_d;   // false where wi and wo are one direction
  double moved;     // to the bin's node, the largest difference in an angle, radians
  bool is_turned;   // h is not at phi = 0, where the node has it: isotropic materials do not mind
};

/// The bin of unit directions. A pair within 1e-5 deg of a node, which is more than the rounding of
/// single precision, counts as at that node, although it may lie on the other side of the edge.
MerlPlace merl_place(const MerlGrid& grid, const brdf::Direction<double>& wi,
                     const brdf::Direction<double>& wo);

/// The solid angle that a bin stands for, of wi times of wo, but for a constant factor; over all
/// bins the sum is 2 pi. It depends on two of the coordinates.
double merl_weight(const MerlGrid& grid, std::size_t theta_h_bin, std::size_t theta_d_bin);

}  // namespace gonio::table
