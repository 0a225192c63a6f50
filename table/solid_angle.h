// The solid angle that a node of an angular grid stands for, so that a fit does not depend on how
// densely the grid samples: between the midpoints to its neighbours.
#pragma once

#include <span>
#include <vector>

namespace gonio::table {

/// For ascending polar angles in radians, from an axis: cos(lower edge) - cos(upper edge) of each
/// node's cell, the solid angle per azimuth. Edges are the midpoints between nodes; the outer cells
/// end as far beyond their node as they reach within, but not below 0 or above `largest`. A single
/// node has 1: there is nothing that it could be weighed against.
std::vector<double> zenith_measures(std::span<const double> theta, double largest);

/// For ascending azimuths in radians: the width of each node's cell. Nodes that span the whole
/// circle, the last one a turn beyond the first, share one cell, half each; else the outer cells
/// reach as far beyond their node as within. A single node has 1.
std::vector<double> azimuth_measures(std::span<const double> phi);

}  // namespace gonio::table
