#include "fit/projection.h"

#include <Eigen/QR>
#include <utility>

#include "fit/bounded_least_squares.h"
#include "fit/channel_amplitudes.h"

namespace gonio::fit {

LinearSystem linear_system_of(const Compressed& compressed, const BatchModel& model,
                              const Eigen::MatrixXd& amplitudes) {
  const Eigen::Index rows = compressed.projected.rows();
  const auto basis_size = Eigen::Index(model.basis_size());
  const Eigen::MatrixXd coefficients = model.coefficients(amplitudes);
  LinearSystem system(std::size_t(amplitudes.cols()));
  for (Eigen::Index c = 0; c < amplitudes.cols(); ++c) {
    const Eigen::MatrixXd& factor = compressed.factor(c);
    ChannelSystem& channel = system[std::size_t(c)];
    channel.amplitude_jacobian.setZero(rows + 1, amplitudes.rows());
    channel.amplitude_jacobian.topRows(rows) =
        factor.leftCols(basis_size) * model.coefficient_jacobian(amplitudes.col(c));
    channel.residuals.resize(rows + 1);
    channel.residuals.head(rows) =
        factor.leftCols(basis_size) * coefficients.col(c) - compressed.projected.col(c);
    channel.residuals[rows] = compressed.unreachable[c];
    channel.shape_jacobian.setZero(rows + 1, Eigen::Index(model.shape_count()));
    const auto derivatives = model.derivatives();
    for (std::size_t d = 0; d < derivatives.size(); ++d) {
      channel.shape_jacobian.col(Eigen::Index(derivatives[d].shape)).head(rows) +=
          coefficients(Eigen::Index(derivatives[d].basis), c) *
          factor.col(basis_size + Eigen::Index(d));
    }
  }
  return system;
}

namespace {

/// Takes out of the Jacobian what the columns reach: the amplitudes that can move follow the shape.
void project_out(const Eigen::MatrixXd& columns, Eigen::MatrixXd& jacobian) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(dependent_share);
  qr.compute(columns);
  auto top = jacobian.topRows(columns.rows());
  const Eigen::MatrixXd reached = columns * qr.solve(Eigen::MatrixXd(top));
  top -= reached;
}

}  // namespace

Projected project(const Compressed& compressed, const BatchModel& model, const Box& box,
                  bool with_jacobian) {
  const Eigen::Index channels = compressed.projected.cols();
  const Eigen::Index rows = compressed.projected.rows();
  const auto basis_size = Eigen::Index(model.basis_size());
  const AmplitudeSpace& space = box.amplitudes;

  Projected result;
  result.amplitudes.resize(Eigen::Index(model.amplitude_count()), channels);
  for (Eigen::Index c = 0; c < channels; ++c) {
    // Below the first basis_size rows the triangle's basis columns are 0.
    const Eigen::MatrixXd basis = compressed.factor(c).topLeftCorner(basis_size, basis_size);
    const FreeAmplitudes amplitudes(box, c);
    result.amplitudes.col(c) = amplitudes.all(
        solve_amplitudes(model, amplitudes, basis, compressed.projected.col(c).head(basis_size)));
    if (with_jacobian) continue;
    ChannelSystem channel;
    channel.residuals.resize(rows + 1);
    channel.residuals.head(rows) = -compressed.projected.col(c);
    channel.residuals.head(basis_size) += basis * model.coefficients(result.amplitudes.col(c));
    channel.residuals[rows] = compressed.unreachable[c];
    result.system.push_back(std::move(channel));
  }
  if (!with_jacobian) return result;

  result.system = linear_system_of(compressed, model, result.amplitudes);
  for (Eigen::Index c = 0; c < channels; ++c) {
    ChannelSystem& channel = result.system[std::size_t(c)];
    const Eigen::MatrixXd basis = channel.amplitude_jacobian.topRows(basis_size) * space.map;
    Eigen::MatrixXd moving(basis_size, basis.cols());
    Eigen::Index moving_count = 0;
    for (Eigen::Index g = 0; g < basis.cols(); ++g) {
      const Eigen::Index k = space.free[std::size_t(g)];
      const double value = result.amplitudes(k, c);
      const double norm = basis.col(g).norm();
      if (value <= box.amplitude_lower(k, c) || value >= box.amplitude_upper(k, c) || norm == 0) {
        continue;
      }
      moving.col(moving_count++) = basis.col(g) / norm;
    }
    if (moving_count > 0 && channel.shape_jacobian.cols() > 0) {
      project_out(moving.leftCols(moving_count), channel.shape_jacobian);
    }
    channel.amplitude_jacobian.resize(rows + 1, 0);
  }
  return result;
}

}  // namespace gonio::fit
