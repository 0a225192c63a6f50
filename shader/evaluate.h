// f_r of many pairs of directions on a Vulkan device, by the shader composed for the model.
#pragma once

#include <span>
#include <vector>

#include "brdf/bound_model.h"
#include "brdf/direction.h"
#include "lut/table.h"
#include "shader/language.h"
#include "shader/vulkan_device.h"

namespace gonio::shader {

/// A look-up table and how the device samples it.
struct TableUse {
  const lut::Table& table;
  lut::Filter filter = lut::Filter::linear;
};

/// [pair][channel], in 1/sr. Throws as VulkanDevice::run.
std::vector<float> evaluate(VulkanDevice& device, const brdf::BoundModel& model,
                            std::span<const brdf::DirectionPair<float>> pairs,
                            Language language = Language::hlsl);

/// The same with the terms that the table serves read from it.
std::vector<float> evaluate(VulkanDevice& device, const brdf::BoundModel& model,
                            const TableUse& use, std::span<const brdf::DirectionPair<float>> pairs,
                            Language language = Language::hlsl);

}  // namespace gonio::shader
