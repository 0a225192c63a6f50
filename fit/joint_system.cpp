#include "fit/joint_system.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fit/columns.h"
#include "fit/residual.h"
#include "fit/triangle.h"

namespace gonio::fit {
namespace {

using brdf::Pack;
using brdf::PackMask;

/// Writes each row's weighted residual, what its Jacobian has to be multiplied by, and the share by
/// which the loss' curvature, rho' + 2 s rho'', is less than the row's weight, rho'; returns the
/// sum of weight * scale^2 * (rho - rho' s).
template <class MetricResidual>
GONIO_FOR_EACH_CPU double weigh(const ChannelColumns& in, const ScaledLoss& loss, double* residuals,
                                double* slopes, double* lacks) {
  const Pack scale(loss.scale);
  Pack beyond(0);
  for (std::size_t i = 0; i < in.count; i += Pack::size) {
    const auto residual = MetricResidual::of(Pack::load(in.values + i), Pack::load(in.model + i),
                                             Pack::load(in.cos_i + i), Pack::load(in.factors + i));
    const Pack weight = Pack::load(in.weights + i);
    const Pack s = (residual.value / scale) * (residual.value / scale);
    const LossValue<Pack> lossy = loss(s);
    const Pack root = sqrt(weight * lossy.slope);
    (root * residual.value).store(residuals + i);
    (root * residual.slope).store(slopes + i);
    const PackMask counts = less(Pack(0), lossy.slope);
    select(counts, Pack(1) - lossy.influence / select(counts, lossy.slope, Pack(1)), Pack(0))
        .store(lacks + i);
    // Below rounding for small s, where it would come out negative as well.
    beyond += weight * larger(Pack(0), lossy.rho - lossy.slope * s);
  }
  return beyond.sum() * loss.scale * loss.scale;
}

/// lacking(a, b) += the sum over the rows of lack * a * b for the columns up to the diagonal;
/// `weighted` is room for one column.
GONIO_FOR_EACH_CPU void add_lacking(const double* rows, const double* lacks, std::size_t columns,
                                    std::size_t count, double* weighted, double* lacking) {
  for (std::size_t a = 0; a < columns; ++a) {
    const double* column = rows + a * std::size_t(column_stride);
    std::fill_n(weighted, count, 0.0);
    add_product(weighted, 1, lacks, column, count);
    for (std::size_t b = 0; b <= a; ++b) {
      lacking[a + b * columns] +=
          inner_product(weighted, rows + b * std::size_t(column_stride), count);
    }
  }
}

struct State {
  std::vector<Triangulation> channels;
  /// Per channel J'J of the rows, each times its lack of curvature; empty without a loss.
  std::vector<Eigen::MatrixXd> lacking;
  Eigen::VectorXd beyond;
  Eigen::MatrixXd columns;  // basis functions and derivatives
};

struct Part {
  std::vector<Triangle> channels;
  std::vector<Eigen::MatrixXd> lacking;
  Eigen::VectorXd beyond;
};

/// What the basis functions of each channel are multiplied by.
struct ChannelCoefficients {
  Eigen::MatrixXd values;                  // [basis, channel]
  std::vector<Eigen::MatrixXd> jacobians;  // [basis, amplitude]; empty where both are the same
};

ChannelCoefficients coefficients_at(const BatchModel& model, const Eigen::MatrixXd& amplitudes) {
  ChannelCoefficients coefficients{model.coefficients(amplitudes), {}};
  if (model.coefficients_kind() == brdf::Coefficients::linear) return coefficients;
  for (Eigen::Index c = 0; c < amplitudes.cols(); ++c) {
    coefficients.jacobians.push_back(model.coefficient_jacobian(amplitudes.col(c)));
  }
  return coefficients;
}

void fold_chunk(const SampleChunk& chunk, const WeightedSamples& samples, const BatchModel& model,
                std::span<const double> shape, const ChannelCoefficients& coefficients,
                const ScaledLoss& loss, State& state) {
  const auto rows = Eigen::Index(chunk.padded_count());
  const auto basis_size = Eigen::Index(model.basis_size());
  const auto amplitude_count = Eigen::Index(model.amplitude_count());
  const auto shape_count = Eigen::Index(model.shape_count());
  model.evaluate(chunk.directions, shape, true, state.columns);
  const auto basis = state.columns.topLeftCorner(rows, basis_size);
  alignas(64) std::array<double, chunk_rows> slopes;
  alignas(64) std::array<double, chunk_rows> lacks;
  alignas(64) std::array<double, chunk_rows> weighted;
  for (Eigen::Index c = 0; c < chunk.values.cols(); ++c) {
    const Eigen::VectorXd expected = basis * coefficients.values.col(c);
    Eigen::MatrixXd& out = state.channels[std::size_t(c)].rows();
    const ChannelColumns in = columns_of(chunk, samples, c, expected.data());
    state.beyond[c] += with_residual(samples.metric(), [&](auto residual) {
      return weigh<decltype(residual)>(in, loss, out.col(amplitude_count + shape_count).data(),
                                       slopes.data(), lacks.data());
    });
    if (coefficients.jacobians.empty()) {
      out.topLeftCorner(rows, amplitude_count) = basis;
    } else {
      out.topLeftCorner(rows, amplitude_count).noalias() =
          basis * coefficients.jacobians[std::size_t(c)];
    }
    out.block(0, amplitude_count, rows, shape_count).setZero();
    for (std::size_t d = 0; d < model.derivatives().size(); ++d) {
      const BatchModel::Derivative derivative = model.derivatives()[d];
      out.col(amplitude_count + Eigen::Index(derivative.shape)).head(rows) +=
          coefficients.values(Eigen::Index(derivative.basis), c) *
          state.columns.col(basis_size + Eigen::Index(d)).head(rows);
    }
    out.topLeftCorner(rows, amplitude_count + shape_count).array().colwise() *=
        Eigen::Map<const Eigen::ArrayXd>(slopes.data(), rows);
    if (!state.lacking.empty()) {
      add_lacking(out.data(), lacks.data(), std::size_t(amplitude_count + shape_count),
                  std::size_t(rows), weighted.data(), state.lacking[std::size_t(c)].data());
    }
    state.channels[std::size_t(c)].fold(chunk.directions.count);
  }
}

/// What must be left of a direction's curvature for Newton's step to be worth it.
constexpr double least_curvature = 0.02;
/// Columns nearer than this to dependent on each other are left to the plain weights.
constexpr double least_pivot = 1e-6;

/// Gauss and Newton's rows, weighed by rho', see more curvature than a robust loss has, and steps
/// come out short. Turns and shrinks the rows so that J'J becomes the loss' own curvature,
/// sum of (rho' + 2 s rho'') J'J, as far as it is positive; J'r stays what it is. `factor` and
/// `projected` are the triangle of the rows, `double_cost` is twice the channel's cost.
void take_curvature_of_loss(const Eigen::MatrixXd& lacking, double double_cost,
                            Eigen::MatrixXd& factor, Eigen::VectorXd& projected) {
  const Eigen::VectorXd norms = factor.colwise().norm();
  if (!((factor.diagonal().array().abs() > least_pivot * norms.array()).all())) return;
  const Eigen::MatrixXd transposed = factor.transpose();
  const auto lower = transposed.triangularView<Eigen::Lower>();
  Eigen::MatrixXd whitened = lacking.selfadjointView<Eigen::Lower>();
  whitened = lower.solve(whitened);
  whitened = lower.solve(Eigen::MatrixXd(whitened.transpose()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      Eigen::MatrixXd::Identity(whitened.rows(), whitened.cols()) - whitened);
  if (eigen.info() != Eigen::Success) return;
  const Eigen::ArrayXd roots = eigen.eigenvalues().array().max(least_curvature).min(1.0).sqrt();
  const Eigen::VectorXd turned =
      ((eigen.eigenvectors().transpose() * projected).array() / roots).matrix();
  // The squares of all rows have to sum to twice the cost.
  if (!(turned.squaredNorm() < double_cost)) return;
  const Eigen::MatrixXd rows =
      roots.matrix().asDiagonal() * (eigen.eigenvectors().transpose() * factor);
  factor = rows;
  projected = turned;
}

ChannelSystem channel_system_of(const Triangle& triangle, const Eigen::MatrixXd* lacking,
                                double beyond, Eigen::Index amplitude_count) {
  Eigen::MatrixXd factor = triangle.factor;
  Eigen::VectorXd projected = triangle.projected.col(0);
  const double double_cost =
      projected.squaredNorm() + triangle.unreachable[0] * triangle.unreachable[0] + beyond;
  double rest = std::hypot(triangle.unreachable[0], std::sqrt(beyond));
  if (lacking != nullptr) {
    take_curvature_of_loss(*lacking, double_cost, factor, projected);
    rest = std::sqrt(std::max(double_cost - projected.squaredNorm(), 0.0));
  }
  const Eigen::Index rows = factor.rows();
  ChannelSystem channel;
  channel.amplitude_jacobian.setZero(rows + 1, amplitude_count);
  channel.amplitude_jacobian.topRows(rows) = factor.leftCols(amplitude_count);
  channel.shape_jacobian.setZero(rows + 1, factor.cols() - amplitude_count);
  channel.shape_jacobian.topRows(rows) = factor.rightCols(factor.cols() - amplitude_count);
  channel.residuals.resize(rows + 1);
  channel.residuals << projected, rest;
  return channel;
}

}  // namespace

bool is_projectable(Metric metric, Loss loss) { return is_linear(metric) && loss == Loss::none; }

LinearSystem joint_system_of(const WeightedSamples& samples, const BatchModel& model,
                             const ParameterValues& values, const ScaledLoss& loss,
                             const PassOptions& passes) {
  const std::size_t channels = samples.channel_count();
  const std::size_t columns = model.amplitude_count() + model.shape_count();
  const ChannelCoefficients coefficients = coefficients_at(model, values.amplitudes);
  const std::vector<Part> parts = chunk_pass(
      samples, passes,
      [&] {
        return State{std::vector<Triangulation>(channels, Triangulation(columns, 1)),
                     std::vector<Eigen::MatrixXd>(
                         loss.loss == Loss::none ? 0 : channels,
                         Eigen::MatrixXd::Zero(Eigen::Index(columns), Eigen::Index(columns))),
                     Eigen::VectorXd::Zero(Eigen::Index(channels)),
                     Eigen::MatrixXd(column_stride, Eigen::Index(model.column_count(true)))};
      },
      [&](const SampleChunk& chunk, State& state) {
        fold_chunk(chunk, samples, model, values.shape, coefficients, loss, state);
      },
      [](const State& state) {
        return Part{triangles_of(state.channels), state.lacking, state.beyond};
      });
  std::vector<std::vector<Triangle>> triangles;
  std::vector<Eigen::MatrixXd> lacking = parts.front().lacking;
  Eigen::VectorXd beyond = parts.front().beyond;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    triangles.push_back(parts[p].channels);
    if (p == 0) continue;
    beyond += parts[p].beyond;
    for (std::size_t c = 0; c < lacking.size(); ++c) lacking[c] += parts[p].lacking[c];
  }

  LinearSystem system;
  for (const Triangle& triangle : merged(triangles)) {
    const std::size_t c = system.size();
    system.push_back(channel_system_of(triangle, lacking.empty() ? nullptr : &lacking[c],
                                       beyond[Eigen::Index(c)],
                                       Eigen::Index(model.amplitude_count())));
  }
  return system;
}

}  // namespace gonio::fit
