// What an evaluator is compared with: the model in double, where a material's table is checked.
//
// Two errors are told. The largest one is of f_r, as a fraction of the lobe's peak
// (lobe_gauge.h), over a grid that is dense in the lobe and over the samples, if there are any. The
// root mean square is of the reflected radiance f_r cos_i, in 1/sr, as the metric cosine-l2 weights
// it: over the samples with their weights, so that it stands beside the residual of a fit to them,
// else over the grid with its solid angles.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brdf/bound_model.h"
#include "brdf/direction.h"
#include "material/material.h"
#include "table/sample_table.h"
#include "trade/lobe_gauge.h"

namespace gonio::trade {

struct Reference {
  /// Their components are floats, as a shader is given them.
  std::vector<brdf::DirectionPair<double>> pairs;
  /// Of the radiance's square in the mean, [pair][channel], at least 0.
  std::vector<double> weights;
  std::size_t channels;
  /// Of the model, in 1/sr, [pair][channel].
  std::vector<double> f_r;
  LobeGauge gauge;
  /// How many of the pairs are samples of a table: the last ones.
  std::size_t samples;
};

/// The grid alone.
Reference reference_on_grid(const brdf::BoundModel& model);

/// The grid and the used samples of a table: those not masked, with both angles up to
/// `max_theta_deg`; a value that was not measured has the weight 0. Throws table::FileError if a
/// channel of the material is none of the table's, or if no sample is left.
Reference reference_on_samples(const brdf::BoundModel& model, const material::Material& material,
                               const table::SampleTable& samples, double max_theta_deg);

/// Every so many of the pairs: about `of_grid` of the grid's, `of_samples` of the samples, and the
/// one with the material's largest value.
Reference thinned(const Reference& reference, std::size_t of_grid, std::size_t of_samples);

struct ErrorPlace {
  double theta_i_deg = 0;
  double theta_o_deg = 0;
  std::size_t channel = 0;
};

/// How far an evaluator is from the model.
struct EvaluatorError {
  double largest = 0;  // as a fraction of the lobe's peak
  ErrorPlace where = {};
  double rms = 0;  // of f_r cos_i, in 1/sr
};

/// Of the values `f_r`, [pair][channel]. A value that is not finite has an infinite error.
EvaluatorError error_of(const Reference& reference, std::span<const double> f_r);

/// The root mean square over the samples of (f - model) cos_i, in 1/sr, with the table's weights:
/// what a fit calls the error cosine-l2. Throws as reference_on_samples().
double cosine_residual(const brdf::BoundModel& model, const material::Material& material,
                       const table::SampleTable& samples, double max_theta_deg);

/// The root mean square of `f_r` cos_i, [pair][channel], in 1/sr.
double radiance_rms(const Reference& reference, std::span<const double> f_r);

}  // namespace gonio::trade
