// A model bound to the values of its parameters: what can be evaluated for a pair of directions.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/model.h"

namespace gonio::brdf {

/// A parameter of a model in the order in which users see them: per term its amplitudes, then its
/// shape.
struct OrderedParameter {
  const ModelParameter* parameter;  // within the model that it was taken from
  bool per_channel;                 // an amplitude; else a shape, shared by all channels
  std::size_t index;                // in model.amplitudes() or model.shape()
};
std::vector<OrderedParameter> ordered_parameters(const Model& model);

/// The values of one parameter: one per channel for an amplitude, a single one for a shape.
struct NamedValues {
  std::string_view name;
  std::span<const double> values;
};

/// The model of that name in the frame that the parameters are for: the free one if a tangent angle
/// (`psi` or `psi_2`) is among them. Whether they suit it is for BoundModel to say. Throws as Model
/// does.
Model model_for(std::string_view name, std::span<const NamedValues> parameters);

/// What is wrong with the values of a parameter; parameter() names it.
class ParameterError : public std::invalid_argument {
 public:
  ParameterError(std::string parameter, const std::string& problem)
      : std::invalid_argument(problem), parameter_(std::move(parameter)) {}
  const std::string& parameter() const { return parameter_; }

 private:
  std::string parameter_;
};

/// An immutable model with all its values.
class BoundModel {
 public:
  /// `parameters` holds every parameter of the model once, in any order. Throws ParameterError for
  /// one that is missing or that the model has not, a wrong number of values, or a value that is
  /// not finite or outside its bounds.
  BoundModel(Model model, std::size_t channel_count, std::span<const NamedValues> parameters);

  const Model& model() const { return model_; }
  std::size_t channel_count() const { return channel_count_; }
  /// As in model().shape().
  std::span<const double> shape() const { return shape_; }
  /// Of the basis functions of model(), for one channel.
  std::span<const double> coefficients(std::size_t channel) const {
    return std::span(coefficients_).subspan(channel * model_.basis_size(), model_.basis_size());
  }

  /// Writes f_r in 1/sr of every channel for the unit vectors `wi`, `wo`. Finite and, for
  /// non-negative amplitudes, at least 0; exactly 0 below the horizon.
  void f_r(const Direction<double>& wi, const Direction<double>& wo,
           std::span<double> values) const;

 private:
  Model model_;
  std::size_t channel_count_;
  std::vector<double> coefficients_;  // [channel][basis function]
  std::vector<double> shape_;
};

}  // namespace gonio::brdf
