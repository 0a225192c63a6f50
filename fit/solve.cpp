#include "fit/solve.h"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fit/projection.h"

namespace gonio::fit {
namespace {

/// A shape parameter that the solver may move, and the variable that stands for it.
class Variable {
 public:
  Variable(std::size_t shape_index, brdf::Scale scale) : index_(shape_index), scale_(scale) {}

  std::size_t index() const { return index_; }
  double from_shape(double value) const { return logarithmic() ? std::log(value) : value; }
  double to_shape(double variable) const { return logarithmic() ? std::exp(variable) : variable; }
  /// d shape / d variable, at the shape's value.
  double slope(double value) const { return logarithmic() ? value : 1; }

 private:
  bool logarithmic() const { return scale_ == brdf::Scale::logarithmic; }
  std::size_t index_;
  brdf::Scale scale_;
};

/// The shape parameters that may move: not fixed, and not held at a bound.
std::vector<Variable> variables_of(const brdf::Model& model, const Box& box,
                                   const std::vector<bool>& held) {
  std::vector<Variable> variables;
  for (std::size_t j = 0; j < model.shape().size(); ++j) {
    if (box.shape_lower[j] == box.shape_upper[j] || held[j]) continue;
    variables.emplace_back(j, model.shape()[j].descriptor.scale);
  }
  return variables;
}

/// The projected problem at the last shape asked for: the solver asks twice for an accepted step,
/// once for its cost and once for its Jacobian, and a pass over the table is dear.
class LastEvaluation {
 public:
  LastEvaluation(const WeightedSamples& samples, const BatchModel& model, const Box& box,
                 const PassOptions& options)
      : samples_(samples), model_(model), box_(box), options_(options) {}

  void move_to(const std::vector<double>& shape) {
    if (shape_ == shape) return;
    compressed_ = compress(samples_, model_, shape, true, options_);
    projected_ = project(compressed_, model_, box_, true);
    shape_ = shape;
  }

  const Compressed& compressed() const { return compressed_; }
  const Projected& projected() const { return projected_; }

 private:
  const WeightedSamples& samples_;
  const BatchModel& model_;
  const Box& box_;
  const PassOptions& options_;
  std::optional<std::vector<double>> shape_;
  Compressed compressed_;
  Projected projected_;
};

class ProjectedCost : public ceres::CostFunction {
 public:
  /// `scale` multiplies the residuals, so that tolerances mean the same for every table.
  ProjectedCost(LastEvaluation& evaluation, const std::vector<Variable>& variables,
                std::vector<double> shape, int residuals, double scale)
      : evaluation_(evaluation), variables_(variables), shape_(std::move(shape)), scale_(scale) {
    set_num_residuals(residuals);
    mutable_parameter_block_sizes()->push_back(int(variables.size()));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    std::vector<double> shape = shape_;
    for (std::size_t v = 0; v < variables_.size(); ++v) {
      shape[variables_[v].index()] = variables_[v].to_shape(parameters[0][v]);
    }
    evaluation_.move_to(shape);
    const Projected& projected = evaluation_.projected();
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = scale_ * projected.residuals;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> jacobian(
        jacobians[0], num_residuals(), Eigen::Index(variables_.size()));
    // A Map with one column is stored the same either way.
    for (std::size_t v = 0; v < variables_.size(); ++v) {
      const std::size_t j = variables_[v].index();
      jacobian.col(Eigen::Index(v)) =
          scale_ * variables_[v].slope(shape[j]) * projected.jacobian.col(Eigen::Index(j));
    }
    return true;
  }

 private:
  LastEvaluation& evaluation_;
  const std::vector<Variable>& variables_;
  std::vector<double> shape_;
  double scale_;
};

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  // Residuals are scaled to a table of norm 1. A noise-free table converges quadratically down to
  // rounding, so that only the step may end it; a noisy one ends when the cost stands still.
  options.function_tolerance = 1e-12;
  options.gradient_tolerance = 1e-17;
  options.parameter_tolerance = 1e-13;
  options.logging_type = ceres::SILENT;
  return options;
}

/// Lets Ceres move the shape's variables from where `shape` stands, within the box.
struct Moved {
  bool converged = true;
  int iterations = 0;
};

Moved move_variables(const std::vector<Variable>& variables, const Box& box,
                     LastEvaluation& evaluation, std::vector<double>& shape) {
  evaluation.move_to(shape);
  if (variables.empty()) return {};
  const double norm = std::hypot(evaluation.compressed().projected.norm(),
                                 evaluation.compressed().unreachable.norm());
  std::vector<double> x;
  for (const Variable& v : variables) x.push_back(v.from_shape(shape[v.index()]));
  ceres::Problem problem;
  problem.AddResidualBlock(
      new ProjectedCost(evaluation, variables, shape, int(evaluation.projected().residuals.size()),
                        norm > 0 ? 1 / norm : 1),
      nullptr, x.data());
  for (std::size_t v = 0; v < variables.size(); ++v) {
    const std::size_t j = variables[v].index();
    problem.SetParameterLowerBound(x.data(), int(v), variables[v].from_shape(box.shape_lower[j]));
    problem.SetParameterUpperBound(x.data(), int(v), variables[v].from_shape(box.shape_upper[j]));
  }
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(), &problem, &summary);
  for (std::size_t v = 0; v < variables.size(); ++v) {
    const std::size_t j = variables[v].index();
    // exp(log(bound)) may miss the bound by a rounding.
    shape[j] = std::clamp(variables[v].to_shape(x[v]), box.shape_lower[j], box.shape_upper[j]);
  }
  evaluation.move_to(shape);
  return {summary.termination_type == ceres::CONVERGENCE,
          std::max(int(summary.iterations.size()) - 1, 0)};
}

/// Holds every parameter that stands at a bound and whose gradient points out of the box, and lets
/// go of those whose gradient points inward. Returns whether anything changed.
bool update_held(const Box& box, const Projected& projected, std::vector<double>& shape,
                 std::vector<bool>& held) {
  const Eigen::VectorXd gradient = projected.jacobian.transpose() * projected.residuals;
  bool changed = false;
  for (std::size_t j = 0; j < held.size(); ++j) {
    if (box.shape_lower[j] == box.shape_upper[j]) continue;
    const double near = 1e-9 * std::abs(shape[j]);
    const bool at_lower = shape[j] - box.shape_lower[j] <= near;
    const bool at_upper = box.shape_upper[j] - shape[j] <= near;
    const double slope = gradient[Eigen::Index(j)];
    const bool hold = (at_lower && slope > 0) || (at_upper && slope < 0);
    if (hold) shape[j] = at_lower ? box.shape_lower[j] : box.shape_upper[j];
    changed = changed || hold != held[j];
    held[j] = hold;
  }
  return changed;
}

}  // namespace

Solution solve(const WeightedSamples& samples, const BatchModel& model, const Box& box,
               std::vector<double> shape, const PassOptions& options) {
  LastEvaluation evaluation(samples, model, box, options);
  Solution solution;
  // Ceres cuts a step off at the box and may then stop though the other parameters could still
  // gain: those at a bound are held, and the rest is solved again, until nothing changes.
  std::vector<bool> held(shape.size(), false);
  const std::size_t most_rounds = 2 * shape.size() + 2;
  bool settled = false;
  for (std::size_t round = 0; round < most_rounds && !settled; ++round) {
    const Moved moved =
        move_variables(variables_of(model.model(), box, held), box, evaluation, shape);
    solution.converged = moved.converged;
    solution.iterations += moved.iterations;
    settled = !update_held(box, evaluation.projected(), shape, held);
  }
  evaluation.move_to(shape);
  solution.converged = solution.converged && settled;
  solution.values = {std::move(shape), evaluation.projected().amplitudes};
  solution.cost = evaluation.projected().cost();
  solution.compressed = evaluation.compressed();
  return solution;
}

}  // namespace gonio::fit
