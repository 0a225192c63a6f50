#include "brdf/bound_model.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "brdf/free_frame.h"
#include "brdf/nearest_name.h"

namespace gonio::brdf {
namespace {

std::string text_of(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string bounds_of(const Parameter& parameter) {
  const std::string unit = parameter.unit == "1" ? "" : ", in " + std::string(parameter.unit);
  if (std::isinf(parameter.upper)) return text_of(parameter.lower) + " or more" + unit;
  return text_of(parameter.lower) + " to " + text_of(parameter.upper) + unit;
}

void check_values(const OrderedParameter& expected, std::span<const double> values,
                  std::size_t channel_count) {
  const std::string& name = expected.parameter->name;
  const Parameter& descriptor = expected.parameter->descriptor;
  const std::size_t count = expected.per_channel ? channel_count : 1;
  if (values.size() != count) {
    throw ParameterError(
        name, "found " + std::to_string(values.size()) +
                  (values.size() == 1 ? " value" : " values") + ", expected " +
                  std::to_string(count) +
                  (expected.per_channel ? ", one per channel" : ", shared by all channels"));
  }
  for (const double value : values) {
    if (std::isfinite(value) && value >= descriptor.lower && value <= descriptor.upper) continue;
    throw ParameterError(name, "found " + text_of(value) + ", outside the bounds of " + name +
                                   ", expected " + bounds_of(descriptor));
  }
}

std::string names_of(const Model& model) {
  std::string names;
  for (const OrderedParameter& p : ordered_parameters(model)) {
    if (!names.empty()) names += ", ";
    names += p.parameter->name;
  }
  return names;
}

std::span<const double> values_of(const Model& model, const OrderedParameter& expected,
                                  std::span<const NamedValues> parameters) {
  const std::string& name = expected.parameter->name;
  const auto is_it = [&](const NamedValues& p) { return p.name == name; };
  const auto found = std::find_if(parameters.begin(), parameters.end(), is_it);
  if (found == parameters.end()) {
    throw ParameterError(
        name, "missing, expected all parameters of " + model.name() + ": " + names_of(model));
  }
  if (std::find_if(found + 1, parameters.end(), is_it) != parameters.end()) {
    throw ParameterError(name, "given twice, expected once");
  }
  return found->values;
}

void refuse_unknown(const Model& model, std::span<const NamedValues> parameters) {
  const auto known = ordered_parameters(model);
  for (const NamedValues& p : parameters) {
    if (std::none_of(known.begin(), known.end(),
                     [&](const OrderedParameter& k) { return k.parameter->name == p.name; })) {
      std::vector<std::string> names;
      for (const OrderedParameter& k : known) names.push_back(k.parameter->name);
      const std::optional<std::string_view> nearest = nearest_name(p.name, names);
      throw ParameterError(std::string(p.name),
                           "not a parameter of " + model.name() +
                               (nearest ? ", did you mean '" + std::string(*nearest) + "'?" : "") +
                               ", expected " + names_of(model));
    }
  }
}

}  // namespace

std::vector<OrderedParameter> ordered_parameters(const Model& model) {
  std::vector<OrderedParameter> result;
  for (std::size_t term = 0; term < model.terms().size(); ++term) {
    for (std::size_t k = 0; k < model.amplitudes().size(); ++k) {
      if (model.amplitudes()[k].term == term) result.push_back({&model.amplitudes()[k], true, k});
    }
    for (std::size_t j = 0; j < model.shape().size(); ++j) {
      if (model.shape()[j].term == term) result.push_back({&model.shape()[j], false, j});
    }
  }
  return result;
}

Model model_for(std::string_view name, std::span<const NamedValues> parameters) {
  const std::string first(tangent_angle.name);
  const std::string second = first + std::string(second_lobe_suffix);
  const bool has_angle =
      std::any_of(parameters.begin(), parameters.end(),
                  [&](const NamedValues& p) { return p.name == first || p.name == second; });
  return Model(name, has_angle ? Frame::free : Frame::of_table);
}

BoundModel::BoundModel(Model model, std::size_t channel_count,
                       std::span<const NamedValues> parameters)
    : model_(std::move(model)),
      channel_count_(channel_count),
      coefficients_(channel_count * model_.basis_size()),
      shape_(model_.shape().size()) {
  refuse_unknown(model_, parameters);
  const std::size_t amplitude_count = model_.amplitudes().size();
  std::vector<double> amplitudes(channel_count * amplitude_count);
  for (const OrderedParameter& expected : ordered_parameters(model_)) {
    const std::span<const double> values = values_of(model_, expected, parameters);
    check_values(expected, values, channel_count);
    if (!expected.per_channel) {
      shape_[expected.index] = values[0];
      continue;
    }
    for (std::size_t c = 0; c < channel_count; ++c) {
      amplitudes[c * amplitude_count + expected.index] = values[c];
    }
  }
  const std::size_t basis_size = model_.basis_size();
  for (std::size_t c = 0; c < channel_count; ++c) {
    model_.coefficients(std::span(amplitudes).subspan(c * amplitude_count, amplitude_count),
                        std::span(coefficients_).subspan(c * basis_size, basis_size));
  }
}

void BoundModel::f_r(const Direction<double>& wi, const Direction<double>& wo,
                     std::span<double> values) const {
  std::array<double, most_basis_functions> basis{};
  model_.basis(shape_, wi, wo, basis);
  const double* coefficient = coefficients_.data();
  for (std::size_t c = 0; c < channel_count_; ++c) {
    double sum = 0;
    for (std::size_t b = 0; b < model_.basis_size(); ++b) sum += *coefficient++ * basis[b];
    values[c] = std::min(sum, std::numeric_limits<double>::max());
  }
}

}  // namespace gonio::brdf
