#include "fit/compression.h"

#include <utility>

#include "fit/triangle.h"

namespace gonio::fit {
namespace {

/// One triangle for all channels where they share the factors, else one per channel.
std::vector<Triangulation> make_triangulations(const WeightedSamples& samples,
                                               std::size_t columns) {
  return samples.shared_factors()
             ? std::vector<Triangulation>{Triangulation(columns, samples.channel_count())}
             : std::vector<Triangulation>(samples.channel_count(), Triangulation(columns, 1));
}

void fold_chunk(const SampleChunk& chunk, const WeightedSamples& samples, const BatchModel& model,
                std::span<const double> shape, bool with_derivatives,
                std::vector<Triangulation>& triangles) {
  const auto rows = Eigen::Index(chunk.padded_count());
  const auto columns = Eigen::Index(model.column_count(with_derivatives));
  model.evaluate(chunk.directions, shape, with_derivatives,
                 triangles.front().rows().leftCols(columns));
  for (std::size_t t = 1; t < triangles.size(); ++t) {
    triangles[t].rows().topLeftCorner(rows, columns) =
        triangles.front().rows().topLeftCorner(rows, columns);
  }
  const Eigen::Index sides = triangles.size() == 1 ? chunk.values.cols() : 1;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto side = Eigen::Index(t);
    Eigen::ArrayXd factor = chunk.factors.col(side).head(rows);
    if (samples.has_weight()) {
      factor *= Eigen::Map<const Eigen::ArrayXd>(chunk.weights.data(), rows).sqrt();
    }
    auto incoming = triangles[t].rows().topRows(rows);
    incoming.leftCols(columns).array().colwise() *= factor;
    incoming.rightCols(sides) =
        (chunk.values.middleCols(side, sides).topRows(rows).array().colwise() * factor).matrix();
    triangles[t].fold(chunk.directions.count);
  }
}

Compressed compressed_of(const std::vector<Triangle>& triangles, std::size_t channels) {
  Compressed compressed;
  compressed.projected.resize(triangles.front().factor.cols(), Eigen::Index(channels));
  compressed.unreachable.resize(Eigen::Index(channels));
  Eigen::Index channel = 0;
  for (const Triangle& triangle : triangles) {
    const Eigen::Index sides = triangle.projected.cols();
    compressed.factors.push_back(triangle.factor);
    compressed.projected.middleCols(channel, sides) = triangle.projected;
    compressed.unreachable.segment(channel, sides) = triangle.unreachable;
    channel += sides;
  }
  return compressed;
}

}  // namespace

Compressed compress(const WeightedSamples& samples, const BatchModel& model,
                    std::span<const double> shape, bool with_derivatives,
                    const PassOptions& options) {
  const std::size_t columns = model.column_count(with_derivatives);
  const std::vector<std::vector<Triangle>> parts = chunk_pass(
      samples, options, [&] { return make_triangulations(samples, columns); },
      [&](const SampleChunk& chunk, std::vector<Triangulation>& triangles) {
        fold_chunk(chunk, samples, model, shape, with_derivatives, triangles);
      },
      triangles_of);
  return compressed_of(merged(parts), samples.channel_count());
}

Compressed compress(const WeightedSamples& samples, std::span<const SampleChunk> chunks,
                    const BatchModel& model, std::span<const double> shape, bool with_derivatives) {
  std::vector<Triangulation> triangles =
      make_triangulations(samples, model.column_count(with_derivatives));
  for (const SampleChunk& chunk : chunks) {
    if (chunk.directions.count == 0) continue;
    fold_chunk(chunk, samples, model, shape, with_derivatives, triangles);
  }
  return compressed_of(triangles_of(triangles), samples.channel_count());
}

}  // namespace gonio::fit
