// The variables that the solver moves, and what they stand for: parameters, roughnesses and other
// scales by their logarithm.
#pragma once

#include <vector>

#include "fit/linear_system.h"
#include "fit/parameters.h"

namespace gonio::fit {

/// One parameter as a variable of the solver.
class Variable {
 public:
  static Variable of_shape(const brdf::Model& model, const Box& box, std::size_t index);
  /// `index` counts the free amplitudes of a channel.
  static Variable of_amplitude(const Box& box, std::size_t index, std::size_t channel);

  double from(const ParameterValues& values) const;
  /// Puts the parameter where the variable says, within its bounds.
  void to(double variable, ParameterValues& values) const;
  /// Infinite for an angle that may go around its period.
  double lower() const;
  double upper() const;
  bool is_fixed() const { return lower_ == upper_; }
  /// The column of a channel's Jacobian by the variable; empty if the channel does not see it.
  Eigen::VectorXd column(const ChannelSystem& system, std::size_t channel, const Box& box,
                         const ParameterValues& values) const;

  /// At the bound within rounding: -1 the lower, 1 the upper, 0 neither.
  int bound_reached(const ParameterValues& values) const;
  void put_on_bound(int bound, ParameterValues& values) const;

 private:
  double parameter(const ParameterValues& values) const;
  double& parameter(ParameterValues& values) const;

  bool is_shape_ = true;
  std::size_t index_ = 0;    // in the shape, or among the amplitudes
  std::size_t free_ = 0;     // among the free amplitudes
  std::size_t channel_ = 0;  // of an amplitude
  brdf::Scale scale_ = brdf::Scale::linear;
  double lower_ = 0;
  double upper_ = 0;
};

/// Variables that Ceres holds in one parameter block.
using VariableBlock = std::vector<Variable>;

}  // namespace gonio::fit
