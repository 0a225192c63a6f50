#include "fit/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "brdf/bound_model.h"

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

/// The unknowns that a user's name stands for. Throws if there is none.
std::vector<Unknown> matching(std::span<const Unknown> unknowns, const std::string& name,
                              const brdf::Model& model) {
  std::vector<Unknown> found;
  std::copy_if(unknowns.begin(), unknowns.end(), std::back_inserter(found),
               [&](const Unknown& u) { return u.name == name || u.parameter == name; });
  if (found.empty()) {
    throw std::invalid_argument(
        fmt::format("model {} with these channels has no parameter '{}'; "
                    "it has {}",
                    model.name(), name, names_of(unknowns)));
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
      unknowns.push_back({name, name, true, ordered.index, 0, false});
      continue;
    }
    for (std::size_t c = 0; c < channels.size(); ++c) {
      unknowns.push_back({name + "." + channels[c], name, false, ordered.index, c, false});
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
  for (const ParameterSetting& setting : options.start) {
    for (const Unknown& u : matching(unknowns, setting.parameter, model)) {
      require_inside(box, u, setting.value, "start");
    }
  }
  return box;
}

}  // namespace gonio::fit
