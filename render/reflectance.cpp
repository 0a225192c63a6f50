#include "render/reflectance.h"

#include <algorithm>
#include <vector>

#include "brdf/float_direction.h"
#include "table/parallel.h"

namespace gonio::render {
namespace {

/// Pairs that one thread evaluates at a time.
constexpr std::size_t chunk_size = 4096;

/// Of anything that has the f_r of a BoundModel.
template <class Model>
Reflectance cpu_reflectance(const Model& model, std::size_t channel_count,
                            const RgbChannels& channels, int threads) {
  return [&model, channel_count, channels, threads](
             std::span<const brdf::DirectionPair<float>> pairs, std::span<Rgb> values) {
    const std::size_t chunks = (pairs.size() + chunk_size - 1) / chunk_size;
    table::parallel_for(chunks, threads, [&](std::size_t chunk) {
      std::vector<double> f_r(channel_count);
      const std::size_t end = std::min(pairs.size(), (chunk + 1) * chunk_size);
      for (std::size_t i = chunk * chunk_size; i < end; ++i) {
        model.f_r(brdf::in_double(pairs[i].wi), brdf::in_double(pairs[i].wo), f_r);
        for (std::size_t c = 0; c < 3; ++c) values[i][c] = saturated(f_r[channels[c]]);
      }
    });
  };
}

}  // namespace

Reflectance model_reflectance(const brdf::BoundModel& model, const RgbChannels& channels,
                              int threads) {
  return cpu_reflectance(model, model.channel_count(), channels, threads);
}

Reflectance table_reflectance(const lut::TableModel& model, std::size_t channel_count,
                              const RgbChannels& channels, int threads) {
  return cpu_reflectance(model, channel_count, channels, threads);
}

Reflectance device_reflectance(shader::VulkanDevice& device, const brdf::BoundModel& model,
                               const RgbChannels& channels,
                               const std::optional<shader::TableUse>& use) {
  return [&device, &model, channels, use](std::span<const brdf::DirectionPair<float>> pairs,
                                          std::span<Rgb> values) {
    const std::vector<float> f_r =
        use ? shader::evaluate(device, model, *use, pairs) : shader::evaluate(device, model, pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        values[i][c] = f_r[i * model.channel_count() + channels[c]];
      }
    }
  };
}

}  // namespace gonio::render
