#include "tests/plain_minimum.h"

#include <ceres/ceres.h>

#include <numbers>

namespace gonio::tests {
namespace {

struct ValueResidual {
  PlainValue value;
  fit::Metric metric;
  double psi;

  /// amplitudes: rho_d, rho_s of the value's channel; shape: alpha_x, alpha_y.
  template <class S>
  bool operator()(const S* amplitudes, const S* shape, S* residual) const {
    const S model = amplitudes[0] / std::numbers::pi +
                    amplitudes[1] * plain_ward(shape[0], shape[1], S(psi), value.wi, value.wo);
    *residual = plain_residual(metric, value.f, model, value.wi.z, value.floor, value.sigma);
    return true;
  }
};

ceres::LossFunction* ceres_loss(fit::Loss loss, double scale, double weight) {
  ceres::LossFunction* inner = nullptr;
  switch (loss) {
    case fit::Loss::none:
      break;
    case fit::Loss::huber:
      inner = new ceres::HuberLoss(scale);
      break;
    case fit::Loss::cauchy:
      inner = new ceres::CauchyLoss(scale);
      break;
    case fit::Loss::tukey:
      inner = new ceres::TukeyLoss(scale);
      break;
  }
  return new ceres::ScaledLoss(inner, weight, ceres::TAKE_OWNERSHIP);
}

}  // namespace

PlainMinimum plain_minimum(const std::vector<PlainValue>& values, fit::Metric metric,
                           fit::Loss loss, double scale, const PlainParameters& start) {
  std::vector<std::array<double, 2>> amplitudes;
  for (std::size_t c = 0; c < start.rho_d.size(); ++c) {
    amplitudes.push_back({double(start.rho_d[c]), double(start.rho_s[c])});
  }
  std::array<double, 2> shape{double(start.alpha_x), double(start.alpha_y)};
  ceres::Problem problem;
  for (const PlainValue& value : values) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ValueResidual, 1, 2, 2>(
                                 new ValueResidual{value, metric, double(start.psi)}),
                             ceres_loss(loss, scale, value.weight),
                             amplitudes[value.channel].data(), shape.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 3000;
  options.function_tolerance = 1e-18;
  options.gradient_tolerance = 1e-18;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  PlainMinimum minimum{summary.final_cost, start, summary.termination_type == ceres::CONVERGENCE};
  for (std::size_t c = 0; c < amplitudes.size(); ++c) {
    minimum.parameters.rho_d[c] = amplitudes[c][0];
    minimum.parameters.rho_s[c] = amplitudes[c][1];
  }
  minimum.parameters.alpha_x = shape[0];
  minimum.parameters.alpha_y = shape[1];
  return minimum;
}

}  // namespace gonio::tests
