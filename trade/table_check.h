// A look-up table against the model whose lobe it holds: which is the weaker part of a shader, the
// table or the fit?
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "brdf/bound_model.h"
#include "lut/layout.h"
#include "lut/table.h"
#include "material/material.h"
#include "shader/vulkan_device.h"
#include "table/sample_table.h"
#include "trade/evaluator_error.h"
#include "trade/reference.h"

namespace gonio::trade {

/// Half a step of an 8-bit display at the lobe's peak: the error that a picture cannot show where
/// the peak is as bright as it can be.
inline constexpr double half_display_step = 1.0 / 510;

/// A table and how it is read.
struct TableChoice {
  lut::Layout layout;
  lut::Filter filter = lut::Filter::linear;
};

/// In bytes.
std::size_t size_of(const lut::Layout& layout);

/// How far a table's path, and the shader without one, are from the model in double.
struct TableCheck {
  TableChoice table;
  /// How many directions were looked at because of where the table's texels are.
  std::size_t at_texels = 0;
  /// By the CPU in double but for the texels: the table's part alone. With weights of the filter as
  /// they are, and rounded to 1/256 as GPUs do.
  EvaluatorError predicted;
  EvaluatorError predicted_quantised;
  /// On a device, in float: the shader that computes the lobe, and the one that reads it.
  std::optional<EvaluatorError> analytic;
  std::optional<EvaluatorError> measured;
};

/// The table's own error by the CPU. Throws std::invalid_argument if the model cannot be evaluated
/// by it.
EvaluatorError predicted_error(const brdf::BoundModel& model, const Reference& reference,
                               const lut::Table& table, lut::Filter filter, lut::Weights weights);

/// All of it, over the reference and where the table's texels are; without a device what it would
/// measure stays empty. Throws std::invalid_argument for a table that the model cannot be evaluated
/// by, and as shader::VulkanDevice::run.
TableCheck check_table(const brdf::BoundModel& model, const Reference& reference,
                       const lut::Table& table, lut::Filter filter, shader::VulkanDevice* device);

/// The same of a table that is baked for it. Throws std::invalid_argument for a layout that is
/// none.
TableCheck check_table(const brdf::BoundModel& model, const Reference& reference,
                       const TableChoice& table, shader::VulkanDevice* device);

/// What was predicted of the table, with whichever weights are worse: a GPU has the rounded ones, a
/// software driver may have the exact ones.
EvaluatorError predicted_error(const TableCheck& check);

/// The table's error that counts: the larger one of what was predicted and what was measured.
EvaluatorError worst_error(const TableCheck& check);

/// What the table's error stands beside; root mean squares of f_r cos_i in 1/sr.
struct FitErrors {
  /// Of the fit: measured less model. Over the samples of the reference, else as the material's
  /// file says; none for a material that was not fitted.
  std::optional<double> residual;
  /// The uncertainty of the parameters carried through the model, over the directions of the
  /// reference.
  std::optional<double> uncertainty;
};

/// `samples` are those of the reference, or null.
FitErrors fit_errors(const brdf::BoundModel& model, const material::Material& material,
                     const Reference& reference, const table::SampleTable* samples,
                     double max_theta_deg);

}  // namespace gonio::trade
