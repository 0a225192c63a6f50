#include "bench/typical_material.h"

#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::bench {
namespace {

constexpr std::size_t channels = 3;

using Values = std::array<double, channels>;

double shape_value(std::string_view name) {
  static const std::map<std::string_view, double> values{
      {"alpha", 0.15},  {"alpha_x", 0.12}, {"alpha_y", 0.27}, {"psi", 0.4},
      {"exponent", 37}, {"n", 43},         {"nu", 80},        {"nv", 23},
      {"sigma", 0.6},   {"s", 0.7},        {"m", 0.35},       {"t", 0.2}};
  const auto found = values.find(name);
  if (found == values.end()) {
    throw std::logic_error("typical_material has no value for the parameter '" + std::string(name) +
                           "'");
  }
  return found->second;
}

Values amplitude_values(std::string_view name) {
  static const std::map<std::string_view, Values> values{
      {"rho_d", {0.45, 0.31, 0.17}}, {"rho_s", {0.11, 0.13, 0.19}}, {"ks", {0.7, 0.8, 0.9}},
      {"Rd", {0.42, 0.29, 0.21}},    {"Rs", {0.06, 0.07, 0.09}},    {"c", {0.62, 0.53, 0.38}}};
  const auto found = values.find(name);
  if (found == values.end()) {
    throw std::logic_error("typical_material has no values for the amplitude '" +
                           std::string(name) + "'");
  }
  return found->second;
}

}  // namespace

brdf::BoundModel typical_material(const brdf::Model& model) {
  // The second lobe of a model is another than the first.
  constexpr double second_amplitude = 0.8;
  constexpr double second_shape = 0.9;
  const auto is_second = [](std::string_view name) {
    return name.ends_with(brdf::second_lobe_suffix);
  };
  std::vector<Values> values;
  for (const brdf::ModelParameter& p : model.amplitudes()) {
    Values own = amplitude_values(p.descriptor.name);
    if (is_second(p.name)) {
      for (double& value : own) value *= second_amplitude;
    }
    values.push_back(own);
  }
  std::vector<double> shape;
  for (const brdf::ModelParameter& p : model.shape()) {
    shape.push_back(shape_value(p.descriptor.name) * (is_second(p.name) ? second_shape : 1));
  }
  std::vector<brdf::NamedValues> named;
  for (std::size_t a = 0; a < values.size(); ++a) {
    named.push_back({model.amplitudes()[a].name, values[a]});
  }
  for (std::size_t s = 0; s < shape.size(); ++s) {
    named.push_back({model.shape()[s].name, std::span(&shape[s], 1)});
  }
  return {model, channels, named};
}

}  // namespace gonio::bench
