// f_r in red, green and blue by whatever evaluates it: the model or a table on the CPU, or a shader
// on a Vulkan device.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "brdf/bound_model.h"
#include "brdf/direction.h"
#include "lut/table_model.h"
#include "render/image.h"
#include "shader/evaluate.h"

namespace gonio::render {

/// Writes f_r in 1/sr for each pair of unit directions, finite and 0 below the horizon. Both spans
/// are of one length.
using Reflectance =
    std::function<void(std::span<const brdf::DirectionPair<float>>, std::span<Rgb>)>;

/// The channels of a model that are shown as red, green and blue.
using RgbChannels = std::array<std::size_t, 3>;

/// The model in double on up to `threads` threads (0: as many as the machine has), the same bits
/// for any number. The model must outlive it; so below.
Reflectance model_reflectance(const brdf::BoundModel& model, const RgbChannels& channels,
                              int threads);

/// The same with the terms that a look-up table serves read from it.
Reflectance table_reflectance(const lut::TableModel& model, std::size_t channel_count,
                              const RgbChannels& channels, int threads);

/// The shader composed for the model, in float on the device; with `use` the one that reads a
/// table. It throws as shader::evaluate() when it is called.
Reflectance device_reflectance(shader::VulkanDevice& device, const brdf::BoundModel& model,
                               const RgbChannels& channels,
                               const std::optional<shader::TableUse>& use = std::nullopt);

}  // namespace gonio::render
