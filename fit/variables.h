// The variables that the solver moves, and what they stand for: parameters, roughnesses and other
// scales by their logarithm.
#pragma once

#include <cstddef>
#include <optional>
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

/// The state of the variables in Ceres, block by block: the amplitudes of each channel unless they
/// are projected out, then the shape. Blocks without variables are left out.
struct VariableState {
  std::vector<VariableBlock> blocks;
  std::vector<std::vector<double>> x;
  std::vector<std::optional<std::size_t>> channels;  // of a block of amplitudes

  /// `rest` with the variables' parameters where x says, and those that depend on them.
  ParameterValues values(ParameterValues rest, const AmplitudeSpace& space) const;
};

/// Which variables there are, and which of them are held at a bound.
class HeldVariables {
 public:
  /// Amplitudes are variables unless they are projected out.
  HeldVariables(const brdf::Model& model, const Box& box, std::size_t channels, bool projectable);

  /// The variables that are not held, where `values` have them.
  VariableState moving(const ParameterValues& values) const;
  std::size_t count() const;
  /// Holds every variable that stands at a bound and whose gradient points out of the box, and lets
  /// go of those whose gradient points inward. Returns whether anything changed.
  bool update(const Box& box, const LinearSystem& system, ParameterValues& values);

 private:
  void add(VariableBlock& block, std::optional<std::size_t> channel);

  std::vector<VariableBlock> blocks_;
  std::vector<std::optional<std::size_t>> channels_;
  std::vector<std::vector<bool>> held_;
};

}  // namespace gonio::fit
