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

/// A reading that the fitted material misses by more than the threshold.
struct Outlier {
  std::size_t sample;  // row of the table, from 0
  std::string channel;
  double residual;  // measured less fitted, in the metric's unit
};

/// The readings that the fit holds for outliers, of whatever loss.
struct Outliers {
  /// How many may be listed.
  static constexpr std::size_t most_listed = 1000;
  double threshold;  // of the residual's magnitude, in the metric's unit; above 0
  std::size_t count;
  std::vector<Outlier> listed;  // the largest ones
};

/// The samples of some incidence angles, predicted by a fit to all the others.
struct HeldOutFold {
  std::pair<double, double> theta_i_deg;  // lowest and highest angle
  std::size_t values;
  double error;  // in the fitted metric
};

struct HeldOut {
  /// Of all the folds together, named and ordered like FitSummary::errors.
  std::vector<std::pair<std::string, double>> errors;
  std::vector<HeldOutFold> folds;
};

/// A model compared with a richer one that contains it: isotropic within anisotropic.
struct NestedComparison {
  std::string in;    // the name of the richer model
  std::string test;  // wald
  double statistic;
  double p_value;  // 0..1: of a statistic as large if the smaller model is true
  std::string text;
};

/// How the parameters were found.
struct FitSummary {
  std::string metric;
  std::string loss;
  std::optional<double> loss_scale;  // in the metric's unit, above 0; none without a robust loss
  std::string covariance;            // known-sigma, residual or sandwich
  std::size_t samples = 0;
  std::size_t used = 0;
  bool converged = false;
  int iterations = 0;
  /// Weighted root mean square of each metric's residual, in a fixed order.
  std::vector<std::pair<std::string, double>> errors;
  std::optional<HeldOut> held_out;
  std::optional<double> reduced_chi2;
  /// Information criteria (Akaike's with small-sample correction, Schwarz's), where sigma is known.
  std::optional<double> aicc;
  std::optional<double> bic;
  std::optional<NestedComparison> nested;
  std::optional<Outliers> outliers;
  /// The rows and columns of `correlation`, "rho_d.R" for a channel's value, "alpha_x" else.
  std::vector<std::string> correlation_parameters;
  std::vector<std::vector<std::optional<double>>> correlation;
  std::vector<std::string> warnings;
};

/// Of a material that was converted from another one: from what, how, and the error that remains.
struct ConversionRecord {
  std::string from;    // "blinn-phong, exponent 50, ..": in words
  std::string method;  // closed-form or best-fit
  std::string metric;  // what the best fit minimised
  double metric_error;
  std::vector<double> theta_i_deg;  // the lights under which the two were compared
  /// As in Difference (comparison.h).
  double peak;
  double rms;
  double albedo;
};

struct MaterialProvenance {
  std::string table;
  std::string sha256;
  std::string gonio;
  std::string command;
};

struct Material {
  std::string name;
  std::string model;  // canonical: brdf::Model::name(); model_of() knows its frame
  std::vector<std::string> channels;
  /// In the model's order: per term its amplitudes, then its shape.
  std::vector<ParameterValue> parameters;
  std::optional<FitSummary> fit;
  std::optional<ConversionRecord> conversion;
  std::optional<MaterialProvenance> provenance;
};

}  // namespace gonio::material
