// The nearest that a renderer's own material comes to one of ours: the values of its parameters at
// which the reflected radiance f_r cos_i differs least, in the metric cosine-l2 (solid angles as
// weights) over the directions of material/comparison.h, diffuse part included.
#pragma once

#include <ceres/jet.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

#include "brdf/direction.h"
#include "export/box_minimum.h"
#include "export/foreign_lobe.h"
#include "material/comparison.h"
#include "table/sample_table.h"

namespace gonio::exports {
namespace nearest_lobe_detail {

/// What one pair of directions asks for: factor * f_r of the stand-in = factor * f_r of the
/// material.
struct Sight {
  brdf::Direction<double> wi, wo;
  std::array<double, 3> f_r;
  double factor;
};

/// The compared samples in the frame of the tangent, scaled so that a black stand-in has a residual
/// of norm 1.
inline std::vector<Sight> sights_of(const table::SampleTable& material, double tangent) {
  const table::SampleFilter is_compared(material, material::largest_compared_theta_deg);
  std::vector<Sight> sights;
  double squared_norm = 0;
  for (std::size_t i = 0; i < material.size(); ++i) {
    if (!is_compared(i)) continue;
    const std::array f_r{material.values[0][i], material.values[1][i], material.values[2][i]};
    const double factor = material.wi.z[i] * std::sqrt(material.weight[i]);
    for (const double value : f_r) squared_norm += value * factor * value * factor;
    sights.push_back({from_tangent(material.wi[i], tangent), from_tangent(material.wo[i], tangent),
                      f_r, factor});
  }
  if (squared_norm > 0) {
    for (Sight& sight : sights) sight.factor /= std::sqrt(squared_norm);
  }
  return sights;
}

/// About `count` of the sights, evenly over all of them. The stride shares no factor with the
/// number of azimuths of a ring of directions: 23 on one side, 44 = 4 times 11 on both.
inline std::vector<Sight> thinned(const std::vector<Sight>& sights, std::size_t count) {
  std::size_t stride = sights.size() / count;
  if (stride <= 1) return sights;
  while (stride % 2 == 0 || stride % 11 == 0 || stride % 23 == 0) ++stride;
  std::vector<Sight> some;
  for (std::size_t i = 0; i < sights.size(); i += stride) some.push_back(sights[i]);
  return some;
}

template <class Lobe, class S>
std::array<S, Lobe::parameters.size()> walked_to(const S* x) {
  using std::exp;
  std::array<S, Lobe::parameters.size()> values;
  for (std::size_t p = 0; p < values.size(); ++p) {
    values[p] = Lobe::parameters[p].walk == Walk::logarithmic ? S(exp(x[p])) : x[p];
  }
  return values;
}

inline double walk_of(const LobeParameter& parameter, double value) {
  return parameter.walk == Walk::logarithmic ? std::log(value) : value;
}

/// Adds (factor * (value - wanted))^2 / 2 of one residual to the sum.
template <int size>
void add_residual(const ceres::Jet<double, size>& value, double wanted, double factor,
                  Quadratic& sum) {
  const double residual = (value.a - wanted) * factor;
  const Eigen::Matrix<double, size, 1> slope = value.v * factor;
  sum.cost += residual * residual / 2;
  sum.gradient.noalias() += residual * slope;
  sum.hessian.noalias() += slope * slope.transpose();
}

template <class Lobe>
Quadratic linearised(std::span<const Sight> sights, const Eigen::VectorXd& x) {
  constexpr int size = int(Lobe::parameters.size());
  using Jet = ceres::Jet<double, size>;
  std::array<Jet, Lobe::parameters.size()> walked;
  for (int p = 0; p < size; ++p) walked[std::size_t(p)] = Jet(x[p], p);
  const auto values = walked_to<Lobe>(walked.data());
  Quadratic sum{0, Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  for (const Sight& sight : sights) {
    const std::array<Jet, 3> rgb = Lobe::template f_r<Jet>(values, sight.wi, sight.wo);
    for (std::size_t c = 0; c < 3; ++c) add_residual(rgb[c], sight.f_r[c], sight.factor, sum);
  }
  return sum;
}

template <class Lobe>
double cost(std::span<const Sight> sights, const Eigen::VectorXd& x) {
  const auto values = walked_to<Lobe>(x.data());
  double sum = 0;
  for (const Sight& sight : sights) {
    const std::array<double, 3> rgb = Lobe::template f_r<double>(values, sight.wi, sight.wo);
    for (std::size_t c = 0; c < 3; ++c) {
      const double residual = (rgb[c] - sight.f_r[c]) * sight.factor;
      sum += residual * residual / 2;
    }
  }
  return sum;
}

/// Where a start is led to, and half the squared norm of the residuals there.
template <class Lobe>
struct Found {
  LobeValues<Lobe> values;
  double cost;
};

template <class Lobe>
Found<Lobe> minimum_from(const LobeValues<Lobe>& start, std::span<const Sight> sights,
                         const Effort& effort) {
  constexpr auto size = Eigen::Index(Lobe::parameters.size());
  BoxProblem problem{
      .lower = Eigen::VectorXd(size),
      .upper = Eigen::VectorXd(size),
      .cost = [&](const Eigen::VectorXd& x) { return cost<Lobe>(sights, x); },
      .linearised = [&](const Eigen::VectorXd& x) { return linearised<Lobe>(sights, x); },
  };
  Eigen::VectorXd from(size);
  for (Eigen::Index p = 0; p < size; ++p) {
    const LobeParameter& parameter = Lobe::parameters[std::size_t(p)];
    problem.lower[p] = walk_of(parameter, parameter.lower);
    problem.upper[p] = walk_of(parameter, parameter.upper);
    from[p] = walk_of(parameter, start[std::size_t(p)]);
  }
  const BoxMinimum minimum = box_minimum(problem, from, effort);
  LobeValues<Lobe> values = walked_to<Lobe>(minimum.x.data());
  for (std::size_t p = 0; p < values.size(); ++p) {
    values[p] = std::clamp(values[p], Lobe::parameters[p].lower, Lobe::parameters[p].upper);
  }
  return {values, minimum.cost};
}

/// Where the starts lead with the tangent at one azimuth.
template <class Lobe>
struct Candidate {
  double tangent;
  Found<Lobe> found;
};

template <class Lobe>
bool is_lower(const Candidate<Lobe>& a, const Candidate<Lobe>& b) {
  return a.found.cost < b.found.cost;
}

/// Every start, followed on some of the directions; the lowest first.
template <class Lobe>
std::vector<Candidate<Lobe>> candidates(const table::SampleTable& material,
                                        std::span<const double> tangents) {
  constexpr std::size_t thinned_count = 5000;
  constexpr Effort effort{.iterations = 40, .cost_tolerance = 1e-5, .step_tolerance = 1e-5};
  std::vector<Candidate<Lobe>> all;
  for (const double tangent : tangents) {
    const std::vector<Sight> some = thinned(sights_of(material, tangent), thinned_count);
    for (const LobeValues<Lobe>& start : Lobe::starts()) {
      all.push_back({tangent, minimum_from<Lobe>(start, some, effort)});
    }
  }
  std::stable_sort(all.begin(), all.end(), is_lower<Lobe>);
  return all;
}

}  // namespace nearest_lobe_detail

/// Where a lobe comes nearest: the values of its parameters, and the azimuth of its tangent in
/// radians.
template <class Lobe>
struct NearestLobe {
  LobeValues<Lobe> values;
  double tangent;
};

/// The parameters of Lobe that come nearest to `material`, which has the three channels R, G and B
/// as material::sample() gives them, with the lobe's tangent at one of the azimuths `tangents` in
/// radians. Within the bounds; the same bits every time. Every start is followed on some of the
/// directions, and the two that end lowest on all of them.
template <class Lobe>
NearestLobe<Lobe> nearest_lobe(const table::SampleTable& material,
                               std::span<const double> tangents) {
  constexpr std::ptrdiff_t followed = 2;
  // Where the lobe can be the material the cost falls quadratically to rounding, so that only the
  // step ends it; else it ends where the cost stands still.
  constexpr Effort effort{.iterations = 200, .cost_tolerance = 1e-9, .step_tolerance = 1e-13};
  auto best = nearest_lobe_detail::candidates<Lobe>(material, tangents);
  best.erase(best.begin() + std::min(followed, std::ssize(best)), best.end());
  for (auto& one : best) {
    one.found = nearest_lobe_detail::minimum_from<Lobe>(
        one.found.values, nearest_lobe_detail::sights_of(material, one.tangent), effort);
  }
  const auto lowest =
      std::min_element(best.begin(), best.end(), nearest_lobe_detail::is_lower<Lobe>);
  return {lowest->found.values, lowest->tangent};
}

}  // namespace gonio::exports
