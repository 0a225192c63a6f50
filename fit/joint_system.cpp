#include "fit/joint_system.h"

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "fit/residual.h"
#include "fit/triangle.h"

namespace gonio::fit {
namespace {

using brdf::Pack;

/// The columns of one channel that its rows are made of, all padded_count() long.
struct ChannelColumns {
  const double* values;
  const double* model;
  const double* cos_i;
  const double* factors;
  const double* weights;
};

/// Writes each row's weighted residual, and what its Jacobian has to be multiplied by; returns the
/// sum of weight * scale^2 * (rho - rho' s).
template <class MetricResidual>
GONIO_FOR_EACH_CPU double weigh(const ChannelColumns& in, const ScaledLoss& loss, std::size_t count,
                                double* residuals, double* slopes) {
  const Pack scale(loss.scale);
  Pack beyond(0);
  for (std::size_t i = 0; i < count; i += Pack::size) {
    const auto residual = MetricResidual::of(Pack::load(in.values + i), Pack::load(in.model + i),
                                             Pack::load(in.cos_i + i), Pack::load(in.factors + i));
    const Pack weight = Pack::load(in.weights + i);
    const Pack s = (residual.value / scale) * (residual.value / scale);
    const LossValue<Pack> lossy = loss(s);
    const Pack root = sqrt(weight * lossy.slope);
    (root * residual.value).store(residuals + i);
    (root * residual.slope).store(slopes + i);
    // Below rounding for small s, where it would come out negative as well.
    beyond += weight * larger(Pack(0), lossy.rho - lossy.slope * s);
  }
  return beyond.sum() * loss.scale * loss.scale;
}

struct State {
  std::vector<Triangulation> channels;
  Eigen::VectorXd beyond;
  Eigen::MatrixXd columns;  // basis functions and derivatives
};

struct Part {
  std::vector<Triangle> channels;
  Eigen::VectorXd beyond;
};

void fold_chunk(const SampleChunk& chunk, const WeightedSamples& samples, const BatchModel& model,
                const ParameterValues& values, const ScaledLoss& loss, State& state) {
  const auto rows = Eigen::Index(chunk.padded_count());
  const auto amplitude_count = Eigen::Index(model.amplitude_count());
  const auto shape_count = Eigen::Index(model.shape_count());
  model.evaluate(chunk.directions, values.shape, true, state.columns);
  const auto basis = state.columns.topLeftCorner(rows, amplitude_count);
  alignas(64) std::array<double, chunk_rows> slopes;
  for (Eigen::Index c = 0; c < chunk.values.cols(); ++c) {
    const Eigen::VectorXd expected = basis * values.amplitudes.col(c);
    Eigen::MatrixXd& out = state.channels[std::size_t(c)].rows();
    const ChannelColumns in{
        chunk.values.col(c).data(), expected.data(), chunk.directions.wi_z.data(),
        chunk.factors.col(samples.factor_column(c)).data(), chunk.weights.data()};
    state.beyond[c] += with_residual(samples.metric(), [&](auto residual) {
      return weigh<decltype(residual)>(in, loss, std::size_t(rows),
                                       out.col(amplitude_count + shape_count).data(),
                                       slopes.data());
    });
    out.topLeftCorner(rows, amplitude_count) = basis;
    out.block(0, amplitude_count, rows, shape_count).setZero();
    for (std::size_t d = 0; d < model.derivatives().size(); ++d) {
      const BatchModel::Derivative derivative = model.derivatives()[d];
      out.col(amplitude_count + Eigen::Index(derivative.shape)).head(rows) +=
          values.amplitudes(Eigen::Index(derivative.amplitude), c) *
          state.columns.col(amplitude_count + Eigen::Index(d)).head(rows);
    }
    out.topLeftCorner(rows, amplitude_count + shape_count).array().colwise() *=
        Eigen::Map<const Eigen::ArrayXd>(slopes.data(), rows);
    state.channels[std::size_t(c)].fold(chunk.directions.count);
  }
}

}  // namespace

bool is_projectable(Metric metric, Loss loss) { return is_linear(metric) && loss == Loss::none; }

LinearSystem joint_system_of(const WeightedSamples& samples, const BatchModel& model,
                             const ParameterValues& values, const ScaledLoss& loss,
                             const PassOptions& passes) {
  const std::size_t channels = samples.channel_count();
  const std::size_t columns = model.amplitude_count() + model.shape_count();
  const std::vector<Part> parts = chunk_pass(
      samples, passes,
      [&] {
        return State{std::vector<Triangulation>(channels, Triangulation(columns, 1)),
                     Eigen::VectorXd::Zero(Eigen::Index(channels)),
                     Eigen::MatrixXd(column_stride, Eigen::Index(model.column_count(true)))};
      },
      [&](const SampleChunk& chunk, State& state) {
        fold_chunk(chunk, samples, model, values, loss, state);
      },
      [](const State& state) {
        return Part{triangles_of(state.channels), state.beyond};
      });
  std::vector<std::vector<Triangle>> triangles;
  Eigen::VectorXd beyond = Eigen::VectorXd::Zero(Eigen::Index(channels));
  for (const Part& part : parts) {
    triangles.push_back(part.channels);
    beyond += part.beyond;
  }

  LinearSystem system;
  const auto rows = Eigen::Index(columns);
  for (const Triangle& triangle : merged(triangles)) {
    ChannelSystem channel;
    channel.amplitude_jacobian.setZero(rows + 1, Eigen::Index(model.amplitude_count()));
    channel.amplitude_jacobian.topRows(rows) =
        triangle.factor.leftCols(Eigen::Index(model.amplitude_count()));
    channel.shape_jacobian.setZero(rows + 1, Eigen::Index(model.shape_count()));
    channel.shape_jacobian.topRows(rows) =
        triangle.factor.rightCols(Eigen::Index(model.shape_count()));
    channel.residuals.resize(rows + 1);
    channel.residuals.head(rows) = triangle.projected.col(0);
    channel.residuals[rows] =
        std::hypot(triangle.unreachable[0], std::sqrt(beyond[Eigen::Index(system.size())]));
    system.push_back(std::move(channel));
  }
  return system;
}

}  // namespace gonio::fit
