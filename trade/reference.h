// What an evaluator is compared with: the model in double, where a material's table is checked.
//
// Two errors are told. The largest one is of f_r, as a fraction of the lobe's peak
// (lobe_gauge.h), over a grid that is dense in the lobe, over directions made for the table that is
// judged, and over the samples, if there are any. The root mean square is of the reflected radiance
// f_r cos_i, in 1/sr, as the metric cosine-l2 weights it: over the samples with their weights, so
// that it stands beside the residual of a fit to them, else over the grid with its solid angles.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brdf/bound_model.h"
#include "brdf/direction.h"
#include "lut/layout.h"
#include "material/material.h"
#include "table/sample_table.h"
#include "trade/lobe_gauge.h"

namespace gonio::trade {

struct Reference {
  /// As a shader is given them.
  std::vector<brdf::DirectionPair<float>> pairs_in_float;
  /// The same numbers.
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

/// At the directions that meet the table's texels and the middles between them
/// (texel_directions.h), or every so many of them, with the weight 0 and the gauge of another
/// reference.
Reference reference_at_texels(const brdf::BoundModel& model, const lut::Layout& layout,
                              const LobeGauge& gauge, std::size_t every = 1);

/// The pairs of both, with the gauge and the samples of the second.
Reference joined(Reference first, const Reference& second);

/// The root mean square over the samples of (f - model) cos_i, in 1/sr, with the table's weights:
/// what a fit calls the error cosine-l2. Throws as reference_on_samples().
double cosine_residual(const brdf::BoundModel& model, const material::Material& material,
                       const table::SampleTable& samples, double max_theta_deg);

/// The root mean square of `f_r` cos_i, [pair][channel], in 1/sr.
double radiance_rms(const Reference& reference, std::span<const double> f_r);

}  // namespace gonio::trade
