// The problem that a fit of any model solves, written down plainly: one loop over the values, the
// model evaluated at one pair of directions at a time, the residuals and losses of plain_problem.h.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "brdf/model.h"
#include "fit/options.h"
#include "fit/parameters.h"
#include "tests/plain_problem.h"

namespace gonio::tests {

class PlainModelProblem {
 public:
  /// The values that a fit with the default filter uses. `model` has to outlive the problem.
  PlainModelProblem(const brdf::Model& model, const table::SampleTable& table, fit::Metric metric)
      : model_(&model), metric_(metric), values_(plain_values(table, plain_floors(table))) {}

  const std::vector<PlainValue>& values() const { return values_; }

  /// The residuals of all the values, not weighted.
  std::vector<double> residuals(const fit::ParameterValues& at) const {
    std::vector<std::array<double, brdf::most_basis_functions>> coefficients(
        std::size_t(at.amplitudes.cols()));
    for (std::size_t c = 0; c < coefficients.size(); ++c) {
      const Eigen::VectorXd amplitudes = at.amplitudes.col(Eigen::Index(c));
      model_->coefficients(std::span(amplitudes.data(), std::size_t(amplitudes.size())),
                           coefficients[c]);
    }
    std::array<double, brdf::most_basis_functions> basis{};
    std::vector<double> out;
    out.reserve(values_.size());
    for (const PlainValue& value : values_) {
      // The channels of a sample come one after the other.
      if (out.empty() || value.sample != (&value - 1)->sample) {
        model_->basis(at.shape, value.wi, value.wo, basis);
      }
      double f = 0;
      for (std::size_t b = 0; b < model_->basis_size(); ++b) {
        f += coefficients[value.channel][b] * basis[b];
      }
      out.push_back(plain_residual(metric_, value.f, f, value.wi.z, value.floor, value.sigma));
    }
    return out;
  }

  double cost(fit::Loss loss, double scale, const fit::ParameterValues& at) const {
    const std::vector<double> all = residuals(at);
    long double sum = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      sum += values_[i].weight * plain_loss(loss, scale, all[i]);
    }
    return double(sum);
  }

 private:
  const brdf::Model* model_;
  fit::Metric metric_;
  std::vector<PlainValue> values_;
};

/// The place of an unknown among the values.
inline double& place_of(const fit::Unknown& unknown, fit::ParameterValues& values) {
  return unknown.is_shape
             ? values.shape[unknown.index]
             : values.amplitudes(Eigen::Index(unknown.index), Eigen::Index(unknown.channel));
}

/// The derivative of function(values) by an unknown: central differences of the fourth order. With
/// steps of 1e-4 of the unknown their truncation is about 1e-17 of its fifth power times the fifth
/// derivative, and their rounding 1e-12 of the function's value.
template <class Function>
auto derivative_of(const Function& function, const fit::Unknown& unknown,
                   const fit::ParameterValues& at) {
  using Value = decltype(function(at));
  const double step = 1e-4 * std::max(1e-2, std::abs(at[unknown]));
  const auto at_offset = [&](double steps) {
    fit::ParameterValues moved = at;
    place_of(unknown, moved) += steps * step;
    return function(moved);
  };
  // No expression may be left behind of what is gone.
  const Value near = at_offset(1) - at_offset(-1);
  const Value far = at_offset(2) - at_offset(-2);
  return Value((8 * near - far) / (12 * step));
}

}  // namespace gonio::tests
