#include "fit/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "brdf/bound_model.h"
#include "brdf/nearest_name.h"
#include "fit/scale.h"

namespace gonio::fit {
namespace {

std::string names_of(std::span<const Unknown> unknowns) {
  std::string names;
  for (const Unknown& unknown : unknowns) {
    for (const std::string& name : {unknown.parameter, unknown.name}) {
      if ((", " + names + ",").find(", " + name + ",") != std::string::npos) continue;
      if (!names.empty()) names += ", ";
      names += name;
    }
  }
  return names;
}

/// "did you mean 'alpha_x'? ", or nothing.
std::string suggestion(std::span<const Unknown> unknowns, const std::string& name) {
  std::vector<std::string> known;
  for (const Unknown& unknown : unknowns) {
    known.push_back(unknown.parameter);
    known.push_back(unknown.name);
  }
  const std::optional<std::string_view> nearest = brdf::nearest_name(name, known);
  return nearest ? fmt::format("did you mean '{}'? ", *nearest) : "";
}

/// The unknowns that a user's name stands for. Throws if there is none.
std::vector<Unknown> matching(std::span<const Unknown> unknowns, const std::string& name,
                              const brdf::Model& model) {
  std::vector<Unknown> found;
  std::copy_if(unknowns.begin(), unknowns.end(), std::back_inserter(found),
               [&](const Unknown& u) { return u.name == name || u.parameter == name; });
  if (found.empty()) {
    throw std::invalid_argument(
        fmt::format("model {} with these channels has no parameter '{}'; {}it has {}", model.name(),
                    name, suggestion(unknowns, name), names_of(unknowns)));
  }
  return found;
}

double& lower_of(Box& box, const Unknown& u) {
  return u.is_shape ? box.shape_lower[u.index]
                    : box.amplitude_lower(Eigen::Index(u.index), Eigen::Index(u.channel));
}

double& upper_of(Box& box, const Unknown& u) {
  return u.is_shape ? box.shape_upper[u.index]
                    : box.amplitude_upper(Eigen::Index(u.index), Eigen::Index(u.channel));
}

AmplitudeSpace all_free(Eigen::Index count) {
  AmplitudeSpace space{{}, Eigen::MatrixXd::Identity(count, count), Eigen::VectorXd::Zero(count)};
  for (Eigen::Index k = 0; k < count; ++k) space.free.push_back(k);
  return space;
}

/// rho_s = 1 - rho_d: the bounds of both become those that both allow.
void make_homogeneous(const brdf::Model& model, Box& box) {
  const auto amplitudes = model.amplitudes();
  const auto index_of = [&](std::string_view name) {
    const auto found = std::find_if(amplitudes.begin(), amplitudes.end(),
                                    [&](const brdf::ModelParameter& p) { return p.name == name; });
    return found == amplitudes.end() ? Eigen::Index(-1) : found - amplitudes.begin();
  };
  const Eigen::Index d = index_of("rho_d");
  const Eigen::Index s = index_of("rho_s");
  if (amplitudes.size() != 2 || d < 0 || s < 0) {
    throw std::invalid_argument(
        fmt::format("homogeneous: rho_s = 1 - rho_d needs a model with one rho_d and one rho_s; {} "
                    "is not one",
                    model.name()));
  }
  for (Eigen::Index c = 0; c < box.amplitude_lower.cols(); ++c) {
    double& lower = box.amplitude_lower(d, c);
    double& upper = box.amplitude_upper(d, c);
    lower = std::max(lower, 1 - box.amplitude_upper(s, c));
    upper = std::min(upper, 1 - box.amplitude_lower(s, c));
    if (!(lower <= upper)) {
      throw std::invalid_argument(
          "homogeneous: the bounds of rho_d and rho_s leave no rho_s = 1 - rho_d");
    }
    box.amplitude_lower(s, c) = 1 - upper;
    box.amplitude_upper(s, c) = 1 - lower;
  }
  box.amplitudes = {{d}, Eigen::MatrixXd::Zero(2, 1), Eigen::VectorXd::Zero(2)};
  box.amplitudes.map(d, 0) = 1;
  box.amplitudes.map(s, 0) = -1;
  box.amplitudes.offset[s] = 1;
}

/// An interval over the end of an angle's period would be two.
void require_within_period(const brdf::Model& model, const Unknown& u,
                           const ParameterBounds& bounds) {
  if (!u.is_shape) return;
  const brdf::Parameter& descriptor = model.shape()[u.index].descriptor;
  if (descriptor.scale != brdf::Scale::periodic ||
      (bounds.lower >= descriptor.lower && bounds.upper <= descriptor.upper)) {
    return;
  }
  throw std::invalid_argument(fmt::format(
      "bounds {}={}:{}: an angle's bounds have to lie between {:.6g} and {:.6g}; turn the table's "
      "frame if the angle is near these",
      u.name, bounds.lower, bounds.upper, descriptor.lower, descriptor.upper));
}

void require_inside(const Box& box, const Unknown& u, double value, std::string_view what) {
  if (std::isfinite(value) && value >= box.lower(u) && value <= box.upper(u)) return;
  throw std::invalid_argument(fmt::format("{} {}={}: outside the bounds {} to {}", what, u.name,
                                          value, box.lower(u), box.upper(u)));
}

}  // namespace

std::vector<Unknown> unknowns_of(const brdf::Model& model, std::span<const std::string> channels) {
  std::vector<Unknown> unknowns;
  for (const brdf::OrderedParameter& ordered : brdf::ordered_parameters(model)) {
    const std::string& name = ordered.parameter->name;
    if (!ordered.per_channel) {
      unknowns.push_back({name, name, true, ordered.index, 0});
      continue;
    }
    for (std::size_t c = 0; c < channels.size(); ++c) {
      unknowns.push_back({name + "." + channels[c], name, false, ordered.index, c});
    }
  }
  return unknowns;
}

bool has_parameter(const brdf::Model& model, std::span<const std::string> channels,
                   std::string_view name) {
  const std::vector<Unknown> unknowns = unknowns_of(model, channels);
  return std::any_of(unknowns.begin(), unknowns.end(),
                     [&](const Unknown& u) { return u.name == name || u.parameter == name; });
}

double ParameterValues::operator[](const Unknown& unknown) const {
  return unknown.is_shape ? shape[unknown.index]
                          : amplitudes(Eigen::Index(unknown.index), Eigen::Index(unknown.channel));
}

bool Box::is_fixed(const Unknown& unknown) const { return lower(unknown) == upper(unknown); }

double Box::lower(const Unknown& unknown) const {
  return unknown.is_shape
             ? shape_lower[unknown.index]
             : amplitude_lower(Eigen::Index(unknown.index), Eigen::Index(unknown.channel));
}

double Box::upper(const Unknown& unknown) const {
  return unknown.is_shape
             ? shape_upper[unknown.index]
             : amplitude_upper(Eigen::Index(unknown.index), Eigen::Index(unknown.channel));
}

Box box_of(const brdf::Model& model, std::span<const std::string> channels,
           const Options& options) {
  Box box;
  for (const brdf::ModelParameter& parameter : model.shape()) {
    box.shape_lower.push_back(parameter.descriptor.lower);
    box.shape_upper.push_back(parameter.descriptor.upper);
  }
  const auto amplitude_count = Eigen::Index(model.amplitudes().size());
  const auto channel_count = Eigen::Index(channels.size());
  box.amplitude_lower.resize(amplitude_count, channel_count);
  box.amplitude_upper.resize(amplitude_count, channel_count);
  for (Eigen::Index k = 0; k < amplitude_count; ++k) {
    const brdf::Parameter& descriptor = model.amplitudes()[std::size_t(k)].descriptor;
    box.amplitude_lower.row(k).setConstant(descriptor.lower);
    box.amplitude_upper.row(k).setConstant(descriptor.upper);
  }

  const std::vector<Unknown> unknowns = unknowns_of(model, channels);
  for (const ParameterBounds& bounds : options.bounds) {
    for (const Unknown& u : matching(unknowns, bounds.parameter, model)) {
      const double lower = std::max(bounds.lower, box.lower(u));
      const double upper = std::min(bounds.upper, box.upper(u));
      if (!(lower <= upper)) {
        throw std::invalid_argument(
            fmt::format("bounds {}={}:{} leave nothing of the model's own bounds {} to {}", u.name,
                        bounds.lower, bounds.upper, box.lower(u), box.upper(u)));
      }
      require_within_period(model, u, bounds);
      lower_of(box, u) = lower;
      upper_of(box, u) = upper;
    }
  }
  for (const ParameterSetting& setting : options.fixed) {
    for (const Unknown& u : matching(unknowns, setting.parameter, model)) {
      require_inside(box, u, setting.value, "fix");
      lower_of(box, u) = setting.value;
      upper_of(box, u) = setting.value;
    }
  }
  box.amplitudes = all_free(amplitude_count);
  if (options.homogeneous) make_homogeneous(model, box);
  for (const ParameterSetting& setting : options.start) {
    for (const Unknown& u : matching(unknowns, setting.parameter, model)) {
      require_inside(box, u, setting.value, "start");
    }
  }
  return box;
}

void mark_unknowns(const Box& box, std::vector<Unknown>& unknowns) {
  const auto& free = box.amplitudes.free;
  for (Unknown& unknown : unknowns) {
    unknown.fixed = box.is_fixed(unknown);
    unknown.dependent = !unknown.is_shape && std::find(free.begin(), free.end(),
                                                       Eigen::Index(unknown.index)) == free.end();
  }
}

bool goes_round(const brdf::Model& model, const Box& box, const Unknown& unknown) {
  if (!unknown.is_shape) return false;
  const brdf::Parameter& descriptor = model.shape()[unknown.index].descriptor;
  return descriptor.scale == brdf::Scale::periodic && box.lower(unknown) == descriptor.lower &&
         box.upper(unknown) == descriptor.upper;
}

double largest_change(const brdf::Model& model, std::span<const double> a,
                      std::span<const double> b) {
  double largest = 0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    const brdf::Parameter& descriptor = model.shape()[j].descriptor;
    double change =
        std::abs(to_variable(descriptor.scale, a[j]) - to_variable(descriptor.scale, b[j]));
    if (descriptor.scale == brdf::Scale::periodic) {
      const double period = descriptor.upper - descriptor.lower;
      change = std::min(change, std::abs(period - change));
    }
    largest = std::max(largest, change);
  }
  return largest;
}

}  // namespace gonio::fit
