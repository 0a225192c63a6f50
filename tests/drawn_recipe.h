// Materials of any model, drawn at random: lobes that are wider than the samples are apart and
// narrower than the hemisphere, and amplitudes that leave every part to be seen.
#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "fit/parameters.h"
#include "fit/scale.h"
#include "instrument/recipe.h"

namespace gonio::tests {

class RecipeDraw {
 public:
  explicit RecipeDraw(std::uint64_t seed) : random_(seed) {}

  /// A parameter of the descriptor's name, spread evenly on its own scale.
  double parameter(const brdf::Parameter& descriptor) {
    const Range range = ranges().at(std::string(descriptor.name));
    const double share = double(random_() >> 11) * 0x1p-53;
    return fit::parameter_between(descriptor.scale, range.lower, range.upper, share);
  }

  /// A material of three channels under five incidences and four rotations, with a dense patch
  /// about the mirror direction; no noise.
  instrument::Recipe recipe(const brdf::Model& model) {
    instrument::Recipe recipe;
    recipe.name = "drawn";
    recipe.model = model.name();
    recipe.channels = {"R", "G", "B"};
    for (const brdf::OrderedParameter& p : brdf::ordered_parameters(model)) {
      for (int value = 0; value < (p.per_channel ? 3 : 1); ++value) {
        recipe.parameters[p.parameter->name].push_back(parameter(p.parameter->descriptor));
      }
    }
    recipe.incidence_angles_deg = {10, 25, 40, 55, 70};
    recipe.sample_rotations_deg = {0, 30, 60, 90};
    recipe.hemisphere = {.theta_step_deg = 10, .phi_step_deg = 30};
    recipe.mirror_patch = instrument::MirrorPatch{
        .radius_step_deg = 2, .radius_max_deg = 16, .directions_per_ring = 12};
    return recipe;
  }

 private:
  struct Range {
    double lower, upper;
  };

  static const std::map<std::string, Range>& ranges() {
    static const std::map<std::string, Range> by_name{
        {"rho_d", {.05, .8}},   {"rho_s", {.02, .4}},   {"ks", {.05, 3}},
        {"Rd", {.05, .9}},      {"Rs", {.02, .9}},      {"c", {.05, .95}},
        {"alpha", {.05, .6}},   {"alpha_x", {.05, .6}}, {"alpha_y", {.05, .6}},
        {"exponent", {2, 500}}, {"n", {2, 500}},        {"nu", {2, 500}},
        {"nv", {2, 500}},       {"sigma", {.05, 1.3}},  {"s", {.1, .95}},
        {"m", {.05, .95}},      {"t", {0, .9}},         {"psi", {-1.5, 1.5}}};
    return by_name;
  }

  std::mt19937_64 random_;
};

/// Two channels of a drawn material with noise of 5 %, and its sigma: about 200 samples.
inline instrument::Recipe two_channel_recipe(const brdf::Model& model, std::uint64_t seed) {
  instrument::Recipe recipe = RecipeDraw(seed).recipe(model);
  recipe.channels = {"R", "G"};
  for (const brdf::ModelParameter& p : model.amplitudes()) recipe.parameters[p.name].pop_back();
  recipe.incidence_angles_deg = {20, 60};
  recipe.sample_rotations_deg = {0, 50};
  recipe.hemisphere = {.theta_step_deg = 20, .phi_step_deg = 60};
  recipe.mirror_patch->radius_step_deg = 8;
  recipe.noise = {.relative = 0.05, .floor = 1e-3, .seed = seed};
  recipe.sigma_columns = true;
  return recipe;
}

/// What the recipe is made of, as a fit of the model would say it.
inline fit::ParameterValues truth_of(const instrument::Recipe& recipe, const brdf::Model& model) {
  fit::ParameterValues values;
  for (const brdf::ModelParameter& p : model.shape()) {
    values.shape.push_back(recipe.parameters.at(p.name).front());
  }
  values.amplitudes.resize(Eigen::Index(model.amplitudes().size()),
                           Eigen::Index(recipe.channels.size()));
  for (Eigen::Index k = 0; k < values.amplitudes.rows(); ++k) {
    const std::vector<double>& of_channels =
        recipe.parameters.at(model.amplitudes()[std::size_t(k)].name);
    for (Eigen::Index c = 0; c < values.amplitudes.cols(); ++c) {
      values.amplitudes(k, c) = of_channels[std::size_t(c)];
    }
  }
  return values;
}

}  // namespace gonio::tests
