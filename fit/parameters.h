// The unknowns of a fit in one row: per term its amplitudes, channel by channel, then its shape.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/model.h"
#include "fit/options.h"

namespace gonio::fit {

/// One scalar unknown.
struct Unknown {
  std::string name;       // "rho_d.R", or "alpha_x"
  std::string parameter;  // "rho_d", "alpha_x"
  bool is_shape;
  std::size_t index;    // among model.shape() or model.amplitudes()
  std::size_t channel;  // of an amplitude
  bool fixed = false;   // set by fit()
  /// Set by fit(): follows from another unknown (rho_s = 1 - rho_d).
  bool dependent = false;
};

std::vector<Unknown> unknowns_of(const brdf::Model& model, std::span<const std::string> channels);

/// True if `name` is one of the model's parameters, or one channel's part of it.
bool has_parameter(const brdf::Model& model, std::span<const std::string> channels,
                   std::string_view name);

/// Values for all the unknowns of a model.
struct ParameterValues {
  std::vector<double> shape;   // as in model.shape()
  Eigen::MatrixXd amplitudes;  // [amplitude, channel], as in model.amplitudes()

  double operator[](const Unknown& unknown) const;
};

/// The amplitudes of a channel as functions of those that are free: offset + map * free.
struct AmplitudeSpace {
  std::vector<Eigen::Index> free;  // indices into the amplitudes
  Eigen::MatrixXd map;             // [amplitude, free]
  Eigen::VectorXd offset;          // [amplitude]
};

/// The closed box that the unknowns are confined to; lower = upper where one is fixed.
struct Box {
  std::vector<double> shape_lower, shape_upper;
  Eigen::MatrixXd amplitude_lower, amplitude_upper;
  AmplitudeSpace amplitudes;

  bool is_fixed(const Unknown& unknown) const;
  double lower(const Unknown& unknown) const;
  double upper(const Unknown& unknown) const;
};

/// The model's own bounds, narrowed by options.bounds and options.fixed, and what
/// options.homogeneous makes of the amplitudes. Throws std::invalid_argument for a parameter that
/// the model has not, a value outside the bounds, bounds that leave nothing, or a homogeneous model
/// whose amplitudes are not one rho_d and one rho_s.
Box box_of(const brdf::Model& model, std::span<const std::string> channels, const Options& options);

/// True for an angle that the box lets go around its period: its bounds are no limits.
bool goes_round(const brdf::Model& model, const Box& box, const Unknown& unknown);

/// The largest change of a shape parameter between two shapes: of the logarithm of a roughness, of
/// an angle in radians and around its period.
double largest_change(const brdf::Model& model, std::span<const double> a,
                      std::span<const double> b);

/// Says of each unknown whether the box fixes it, or whether it depends on another one.
void mark_unknowns(const Box& box, std::vector<Unknown>& unknowns);

}  // namespace gonio::fit
