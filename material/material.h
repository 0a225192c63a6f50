// Material: a model with its parameters, and how sure each of them is.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "brdf/model.h"

namespace gonio::material {

/// The values of one parameter: one per channel for an amplitude, a single one for a shape.
/// stddev and interval95 are empty where no fit stands behind the value; a single entry without
/// a value means that the data could not determine it.
struct ParameterValue {
  std::string name;
  std::vector<double> value;
  std::vector<std::optional<double>> stddev;
  std::vector<std::optional<std::pair<double, double>>> interval95;
};

/// How the parameters were found.
struct FitSummary {
  std::string metric;
  std::string loss;
  std::string covariance;  // known-sigma, residual or sandwich
  std::size_t samples = 0;
  std::size_t used = 0;
  bool converged = false;
  int iterations = 0;
  /// Weighted root mean square of each metric's residual, in a fixed order.
  std::vector<std::pair<std::string, double>> errors;
  std::optional<double> reduced_chi2;
  /// The rows and columns of `correlation`, "rho_d.R" for a channel's value, "alpha_x" else.
  std::vector<std::string> correlation_parameters;
  std::vector<std::vector<std::optional<double>>> correlation;
  std::vector<std::string> warnings;
};

struct MaterialProvenance {
  std::string table;
  std::string sha256;
  std::string gonio;
  std::string command;
};

struct Material {
  std::string name;
  std::string model;  // canonical: brdf::Model::name()
  std::vector<std::string> channels;
  /// In the model's order: per term its amplitudes, then its shape.
  std::vector<ParameterValue> parameters;
  std::optional<FitSummary> fit;
  std::optional<MaterialProvenance> provenance;
};

}  // namespace gonio::material
