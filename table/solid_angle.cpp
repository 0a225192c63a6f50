#include "table/solid_angle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gonio::table {
namespace {

/// The midpoints between nodes, and the outer edges beyond the first and the last, by symmetry.
std::vector<double> cell_edges(std::span<const double> nodes) {
  std::vector<double> edges(nodes.size() + 1);
  for (std::size_t i = 1; i < nodes.size(); ++i) edges[i] = (nodes[i - 1] + nodes[i]) / 2;
  edges.front() = 2 * nodes.front() - edges[1];
  edges.back() = 2 * nodes.back() - edges[nodes.size() - 1];
  return edges;
}

}  // namespace

std::vector<double> zenith_measures(std::span<const double> theta, double largest) {
  std::vector<double> measures(theta.size(), 1);
  if (theta.size() < 2) return measures;
  std::vector<double> edges = cell_edges(theta);
  for (double& edge : edges) edge = std::clamp(edge, 0.0, largest);
  for (std::size_t i = 0; i < theta.size(); ++i) {
    // cos a - cos b without the cancellation of small angles.
    measures[i] =
        2 * std::sin((edges[i + 1] + edges[i]) / 2) * std::sin((edges[i + 1] - edges[i]) / 2);
  }
  return measures;
}

std::vector<double> azimuth_measures(std::span<const double> phi) {
  constexpr double same_azimuth = 1e-5;  // files round the whole circle to some digits
  std::vector<double> measures(phi.size(), 1);
  if (phi.size() < 2) return measures;
  std::vector<double> edges = cell_edges(phi);
  const double turn = 2 * std::numbers::pi;
  if (std::abs(phi.back() - phi.front() - turn) < same_azimuth) {
    edges.front() = phi.front();
    edges.back() = phi.back();
  }
  for (std::size_t i = 0; i < phi.size(); ++i) measures[i] = edges[i + 1] - edges[i];
  return measures;
}

}  // namespace gonio::table
