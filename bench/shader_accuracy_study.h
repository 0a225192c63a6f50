// How far an exported shader's f_r is from the model's, in fractions of the lobe's peak, when a
// device runs it: both languages, every model.
//
// The reference is brdf::BoundModel::f_r in double on the components that the shader is given, as
// floats and not normalised again: what the shader's own arithmetic loses. What the rounding of the
// directions to float costs, which no function of floats can help, is a number of its own, with a
// bound (input_rounding_bound).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "bench/shader_directions.h"
#include "bench/shader_materials.h"
#include "shader/language.h"
#include "shader/vulkan_device.h"

namespace gonio::bench {

/// The largest error that an exported shader may have in the gauge of ShaderErrors::worst.
inline constexpr double shader_figure = 2e-5;

struct ShaderAccuracySettings {
  std::size_t pairs = 100'000;  // of directions, for each material
  std::uint64_t seed = 1;
};

/// Where an error was found.
struct ShaderError {
  double error = 0;
  std::size_t channel = 0;
  double expected = 0;
  double found = 0;
  DirectionPair<float> pair{};
};

/// Of one material in one language.
struct ShaderErrors {
  std::string model;
  std::string parameters;
  shader::Language language{};
  /// |shader - model| as a fraction of the lobe's peak, or of f_r where that is larger
  /// (trade/lobe_gauge.h).
  ShaderError worst;
  /// The same as a fraction of the peak everywhere.
  ShaderError worst_of_peak;
  /// What the rounding of the directions changes, as a fraction of the peak, over the pairs with
  /// both angles up to 60 degrees.
  double input_rounding = 0;
  double input_rounding_bound = 0;  // the function of that name
  std::size_t not_finite = 0;
  /// Values other than 0 on the horizon or below it.
  std::size_t lit_below_horizon = 0;
};

/// Both languages of one material.
std::vector<ShaderErrors> shader_errors(const ShaderMaterial& material,
                                        const ShaderAccuracySettings& settings,
                                        shader::VulkanDevice& device);

/// All materials of all models.
std::vector<ShaderErrors> shader_accuracy(LobeWidths widths, const ShaderAccuracySettings& settings,
                                          shader::VulkanDevice& device);

/// True if the figure holds, all values are finite and those below the horizon 0.
bool figure_holds(const ShaderErrors& errors);

/// An upper bound, to first order, of what the rounding of the directions to float changes, as a
/// fraction of the peak, at angles up to 60 degrees. Derived in docs/shaders.md.
double input_rounding_bound(const ShaderMaterial& material);

}  // namespace gonio::bench
