#include "fit/variables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fit/scale.h"

namespace gonio::fit {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

Variable Variable::of_shape(const brdf::Model& model, const Box& box, std::size_t index) {
  const brdf::Parameter& descriptor = model.shape()[index].descriptor;
  Variable variable;
  variable.index_ = index;
  variable.scale_ = descriptor.scale;
  variable.lower_ = box.shape_lower[index];
  variable.upper_ = box.shape_upper[index];
  if (descriptor.scale == brdf::Scale::quadratic && !variable.is_fixed()) {
    variable.lower_ = std::min(std::max(variable.lower_, least_root), variable.upper_);
  }
  // Confined to less than a period, an angle is a number like others.
  if (descriptor.scale == brdf::Scale::periodic &&
      (variable.lower_ > descriptor.lower || variable.upper_ < descriptor.upper)) {
    variable.scale_ = brdf::Scale::linear;
  }
  return variable;
}

Variable Variable::of_amplitude(const Box& box, std::size_t index, std::size_t channel) {
  Variable variable;
  variable.is_shape_ = false;
  variable.free_ = index;
  variable.index_ = std::size_t(box.amplitudes.free[index]);
  variable.channel_ = channel;
  variable.lower_ = box.amplitude_lower(Eigen::Index(variable.index_), Eigen::Index(channel));
  variable.upper_ = box.amplitude_upper(Eigen::Index(variable.index_), Eigen::Index(channel));
  return variable;
}

double Variable::parameter(const ParameterValues& values) const {
  return is_shape_ ? values.shape[index_]
                   : values.amplitudes(Eigen::Index(index_), Eigen::Index(channel_));
}

double& Variable::parameter(ParameterValues& values) const {
  return is_shape_ ? values.shape[index_]
                   : values.amplitudes(Eigen::Index(index_), Eigen::Index(channel_));
}

double Variable::from(const ParameterValues& values) const {
  const double value = parameter(values);
  return to_variable(scale_, std::clamp(value, lower_, upper_));
}

void Variable::to(double variable, ParameterValues& values) const {
  if (scale_ == brdf::Scale::periodic) {
    const double period = upper_ - lower_;
    parameter(values) =
        std::clamp(variable - period * std::floor((variable - lower_) / period), lower_, upper_);
    return;
  }
  // exp(log(bound)) may miss the bound by a rounding.
  parameter(values) = std::clamp(from_variable(scale_, variable), lower_, upper_);
}

double Variable::lower() const {
  if (scale_ == brdf::Scale::periodic) return -infinity;
  return to_variable(scale_, lower_);
}

double Variable::upper() const {
  if (scale_ == brdf::Scale::periodic) return infinity;
  return to_variable(scale_, upper_);
}

Eigen::VectorXd Variable::column(const ChannelSystem& system, std::size_t channel, const Box& box,
                                 const ParameterValues& values) const {
  if (is_shape_) {
    const double slope = parameter_slope(scale_, parameter(values));
    return slope * system.shape_jacobian.col(Eigen::Index(index_));
  }
  if (channel != channel_) return {};
  return system.amplitude_jacobian * box.amplitudes.map.col(Eigen::Index(free_));
}

int Variable::bound_reached(const ParameterValues& values) const {
  if (scale_ == brdf::Scale::periodic) return 0;
  const double value = parameter(values);
  const double near = 1e-9 * std::abs(value);
  if (value - lower_ <= near) return -1;
  return upper_ - value <= near ? 1 : 0;
}

void Variable::put_on_bound(int bound, ParameterValues& values) const {
  parameter(values) = bound < 0 ? lower_ : upper_;
}

namespace {

ParameterValues with_dependent(ParameterValues values, const AmplitudeSpace& space) {
  if (values.amplitudes.size() == 0) return values;
  const Eigen::MatrixXd free = values.amplitudes(space.free, Eigen::all);
  values.amplitudes = (space.map * free).colwise() + space.offset;
  return values;
}

}  // namespace

ParameterValues VariableState::values(ParameterValues rest, const AmplitudeSpace& space) const {
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::size_t v = 0; v < blocks[b].size(); ++v) blocks[b][v].to(x[b][v], rest);
  }
  return with_dependent(std::move(rest), space);
}

HeldVariables::HeldVariables(const brdf::Model& model, const Box& box, std::size_t channels,
                             bool projectable) {
  if (!projectable) {
    for (std::size_t c = 0; c < channels; ++c) {
      VariableBlock block;
      for (std::size_t g = 0; g < box.amplitudes.free.size(); ++g) {
        block.push_back(Variable::of_amplitude(box, g, c));
      }
      add(block, c);
    }
  }
  VariableBlock shape;
  for (std::size_t j = 0; j < model.shape().size(); ++j) {
    shape.push_back(Variable::of_shape(model, box, j));
  }
  add(shape, std::nullopt);
}

VariableState HeldVariables::moving(const ParameterValues& values) const {
  VariableState state;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    VariableBlock block;
    std::vector<double> x;
    for (std::size_t v = 0; v < blocks_[b].size(); ++v) {
      if (held_[b][v]) continue;
      block.push_back(blocks_[b][v]);
      x.push_back(blocks_[b][v].from(values));
    }
    if (block.empty()) continue;
    state.blocks.push_back(std::move(block));
    state.x.push_back(std::move(x));
    state.channels.push_back(channels_[b]);
  }
  return state;
}

std::size_t HeldVariables::count() const {
  std::size_t sum = 0;
  for (const VariableBlock& block : blocks_) sum += block.size();
  return sum;
}

bool HeldVariables::update(const Box& box, const LinearSystem& system, ParameterValues& values) {
  bool changed = false;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    for (std::size_t v = 0; v < blocks_[b].size(); ++v) {
      const Variable& variable = blocks_[b][v];
      const int bound = variable.bound_reached(values);
      double gradient = 0;
      for (std::size_t c = 0; c < system.size(); ++c) {
        const Eigen::VectorXd column = variable.column(system[c], c, box, values);
        if (column.size() > 0) gradient += column.dot(system[c].residuals);
      }
      const bool hold = (bound < 0 && gradient > 0) || (bound > 0 && gradient < 0);
      if (hold) variable.put_on_bound(bound, values);
      changed = changed || hold != held_[b][v];
      held_[b][v] = hold;
    }
  }
  values = with_dependent(std::move(values), box.amplitudes);
  return changed;
}

void HeldVariables::add(VariableBlock& block, std::optional<std::size_t> channel) {
  std::erase_if(block, [](const Variable& v) { return v.is_fixed(); });
  if (block.empty()) return;
  held_.emplace_back(block.size(), false);
  channels_.push_back(channel);
  blocks_.push_back(std::move(block));
}

}  // namespace gonio::fit
