#include "shader/evaluate.h"

#include <cstdint>
#include <limits>

#include "shader/compose.h"
#include "shader/spirv.h"

namespace gonio::shader {
namespace {

/// No name is seen: the text goes to the compiler.
const SourceText unnamed{.name = "material", .header = {}};

/// As evaluation_kernel() wants them.
std::vector<float> components_of(std::span<const brdf::DirectionPair<float>> pairs) {
  std::vector<float> components;
  components.reserve(6 * pairs.size());
  for (const auto& [wi, wo] : pairs) {
    components.insert(components.end(), {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z});
  }
  return components;
}

std::vector<float> run(VulkanDevice& device, const std::string& kernel, Language language,
                       std::size_t channels, std::span<const brdf::DirectionPair<float>> pairs,
                       const SampledTexture* texture) {
  if (pairs.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("evaluate: found " + std::to_string(pairs.size()) +
                                " pairs of directions, expected at most 4294967295");
  }
  return device.run(compile(kernel, language), components_of(pairs), channels * pairs.size(),
                    static_cast<std::uint32_t>(pairs.size()), texture);
}

}  // namespace

std::vector<float> evaluate(VulkanDevice& device, const brdf::BoundModel& model,
                            std::span<const brdf::DirectionPair<float>> pairs, Language language) {
  return run(device, evaluation_kernel(model, language, unnamed), language, model.channel_count(),
             pairs, nullptr);
}

std::vector<float> evaluate(VulkanDevice& device, const brdf::BoundModel& model,
                            const TableUse& use, std::span<const brdf::DirectionPair<float>> pairs,
                            Language language) {
  const SampledTexture texture{use.table.texture, use.filter};
  return run(device, evaluation_kernel(model, use.table, language, unnamed), language,
             model.channel_count(), pairs, &texture);
}

}  // namespace gonio::shader
