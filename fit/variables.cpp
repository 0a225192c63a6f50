#include "fit/variables.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
  return scale_ == brdf::Scale::logarithmic ? std::log(value) : value;
}

void Variable::to(double variable, ParameterValues& values) const {
  if (scale_ == brdf::Scale::periodic) {
    const double period = upper_ - lower_;
    parameter(values) =
        std::clamp(variable - period * std::floor((variable - lower_) / period), lower_, upper_);
    return;
  }
  // exp(log(bound)) may miss the bound by a rounding.
  parameter(values) = std::clamp(scale_ == brdf::Scale::logarithmic ? std::exp(variable) : variable,
                                 lower_, upper_);
}

double Variable::lower() const {
  if (scale_ == brdf::Scale::periodic) return -infinity;
  return scale_ == brdf::Scale::logarithmic ? std::log(lower_) : lower_;
}

double Variable::upper() const {
  if (scale_ == brdf::Scale::periodic) return infinity;
  return scale_ == brdf::Scale::logarithmic ? std::log(upper_) : upper_;
}

Eigen::VectorXd Variable::column(const ChannelSystem& system, std::size_t channel, const Box& box,
                                 const ParameterValues& values) const {
  if (is_shape_) {
    const double slope = scale_ == brdf::Scale::logarithmic ? parameter(values) : 1;
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

}  // namespace gonio::fit
