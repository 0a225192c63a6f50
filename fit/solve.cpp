#include "fit/solve.h"

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/iteration_callback.h>
#include <ceres/ordered_groups.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "fit/bounded_least_squares.h"
#include "fit/evaluation.h"
#include "fit/variables.h"

namespace gonio::fit {
namespace {

/// With more channels than this the amplitudes are eliminated channel by channel.
constexpr std::size_t most_dense_channels = 8;

/// Evaluates the problem where the variables stand, whenever Ceres has moved them.
class Mover : public ceres::EvaluationCallback {
 public:
  Mover(LastEvaluation& evaluation, const VariableState& state, ParameterValues rest,
        const Box& box)
      : evaluation_(evaluation), state_(state), rest_(std::move(rest)), box_(box) {}

  void PrepareForEvaluation(bool /*evaluate_jacobians*/, bool /*new_evaluation_point*/) override {
    evaluation_.move_to(state_.values(rest_, box_.amplitudes));
  }

 private:
  LastEvaluation& evaluation_;
  const VariableState& state_;
  ParameterValues rest_;
  const Box& box_;
};

/// The rows of one channel.
class ChannelCost : public ceres::CostFunction {
 public:
  /// `blocks` are those of the state that the channel depends on. `scale` multiplies the residuals,
  /// so that tolerances mean the same for every table.
  ChannelCost(const LastEvaluation& evaluation, const VariableState& state,
              std::vector<std::size_t> blocks, std::size_t channel, const Box& box, double scale)
      : evaluation_(evaluation),
        state_(state),
        blocks_(std::move(blocks)),
        channel_(channel),
        box_(box),
        scale_(scale) {
    set_num_residuals(int(evaluation.system()[channel].residuals.size()));
    for (const std::size_t b : blocks_) {
      mutable_parameter_block_sizes()->push_back(int(state.blocks[b].size()));
    }
  }

  bool Evaluate(double const* const* /*parameters*/, double* residuals,
                double** jacobians) const override {
    const ChannelSystem& system = evaluation_.system()[channel_];
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = scale_ * system.residuals;
    if (jacobians == nullptr) return true;
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      if (jacobians[k] == nullptr) continue;
      const VariableBlock& block = state_.blocks[blocks_[k]];
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> jacobian(
          jacobians[k], num_residuals(), Eigen::Index(block.size()));
      for (std::size_t v = 0; v < block.size(); ++v) {
        jacobian.col(Eigen::Index(v)) =
            scale_ * block[v].column(system, channel_, box_, evaluation_.values());
      }
    }
    return true;
  }

 private:
  const LastEvaluation& evaluation_;
  const VariableState& state_;
  std::vector<std::size_t> blocks_;
  std::size_t channel_;
  const Box& box_;
  double scale_;
};

/// The step of Gauss and Newton in the variables of a single block, and what it would gain.
struct Step {
  Eigen::VectorXd change;
  double gain = 0;  // of the cost

  double size() const { return change.lpNorm<Eigen::Infinity>(); }
};

Step gauss_newton_step(const LastEvaluation& evaluation, const VariableState& state,
                       const Box& box) {
  const LinearSystem& system = evaluation.system();
  const Eigen::Index rows = system.front().residuals.size();
  const VariableBlock& block = state.blocks.front();
  Eigen::MatrixXd jacobian(rows * Eigen::Index(system.size()), Eigen::Index(block.size()));
  Eigen::VectorXd residuals(jacobian.rows());
  for (std::size_t c = 0; c < system.size(); ++c) {
    residuals.segment(rows * Eigen::Index(c), rows) = system[c].residuals;
    for (std::size_t v = 0; v < block.size(); ++v) {
      jacobian.col(Eigen::Index(v)).segment(rows * Eigen::Index(c), rows) =
          block[v].column(system[c], c, box, evaluation.values());
    }
  }
  Step step;
  step.change = jacobian.colPivHouseholderQr().solve(-residuals);
  step.gain = (jacobian * step.change).squaredNorm() / 2;
  return step;
}

/// Ends the iterations where the step after the next one would be smaller than the precision that
/// is asked for: the next one can be taken without looking at the samples again. Steps shrink at
/// least as much from one to the next as they did before.
class LastStepCallback : public ceres::IterationCallback {
 public:
  LastStepCallback(const LastEvaluation& evaluation, const VariableState& state, const Box& box,
                   double precision, std::size_t used_values)
      : evaluation_(evaluation),
        state_(state),
        box_(box),
        precision_(precision),
        used_values_(used_values) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (!summary.step_is_successful && summary.iteration > 0) return ceres::SOLVER_CONTINUE;
    if (is_stalled(summary)) return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    Step step = gauss_newton_step(evaluation_, state_, box_);
    const double size = step.size();
    const double ratio = previous_size_ > size ? size / previous_size_ : 1;
    previous_size_ = size;
    if (!(size * ratio <= precision_)) return ceres::SOLVER_CONTINUE;
    step_ = std::move(step);
    return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
  }

  /// The step that is left to take, if the iterations were ended here.
  const std::optional<Step>& step() const { return step_; }

 private:
  /// True after several steps that gained nothing beside the noise: a valley's floor, along which
  /// the parameters are not determined any better.
  bool is_stalled(const ceres::IterationSummary& summary) {
    constexpr double negligible = 1e-6;
    constexpr int most_idle_steps = 5;
    const double variance = 2 * summary.cost / double(std::max<std::size_t>(used_values_, 1));
    const bool is_idle = summary.iteration > 0 && summary.cost_change < negligible * variance;
    idle_steps_ = is_idle ? idle_steps_ + 1 : 0;
    return idle_steps_ >= most_idle_steps;
  }

  const LastEvaluation& evaluation_;
  const VariableState& state_;
  const Box& box_;
  double precision_;
  std::size_t used_values_;
  int idle_steps_ = 0;
  double previous_size_ = 0;
  std::optional<Step> step_;
};

ceres::Solver::Options solver_options(const VariableState& state, double precision) {
  ceres::Solver::Options options;
  options.max_num_iterations = 200;
  // Residuals are scaled to a table of norm 1. A noise-free table converges quadratically down to
  // rounding, so that only the step may end it; a noisy one ends when the cost stands still.
  options.function_tolerance = std::max(1e-12, precision * precision);
  options.gradient_tolerance = 1e-17;
  options.parameter_tolerance = 1e-13;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::DENSE_QR;
  const auto of_amplitudes =
      std::size_t(std::count_if(state.channels.begin(), state.channels.end(),
                                [](const auto& channel) { return channel.has_value(); }));
  if (of_amplitudes > most_dense_channels && of_amplitudes < state.blocks.size()) {
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  }
  return options;
}

void add_blocks(VariableState& state, const LastEvaluation& evaluation, const Box& box,
                double scale, ceres::Problem& problem, ceres::Solver::Options& options) {
  for (std::size_t c = 0; c < evaluation.system().size(); ++c) {
    std::vector<std::size_t> blocks;
    std::vector<double*> pointers;
    for (std::size_t b = 0; b < state.blocks.size(); ++b) {
      if (state.channels[b].value_or(c) != c) continue;
      blocks.push_back(b);
      pointers.push_back(state.x[b].data());
    }
    if (blocks.empty()) continue;
    problem.AddResidualBlock(new ChannelCost(evaluation, state, blocks, c, box, scale), nullptr,
                             pointers);
  }
  for (std::size_t b = 0; b < state.blocks.size(); ++b) {
    for (std::size_t v = 0; v < state.blocks[b].size(); ++v) {
      const Variable& variable = state.blocks[b][v];
      if (std::isfinite(variable.lower())) {
        problem.SetParameterLowerBound(state.x[b].data(), int(v), variable.lower());
      }
      if (std::isfinite(variable.upper())) {
        problem.SetParameterUpperBound(state.x[b].data(), int(v), variable.upper());
      }
    }
    if (options.linear_solver_ordering) {
      options.linear_solver_ordering->AddElementToGroup(state.x[b].data(),
                                                        state.channels[b] ? 0 : 1);
    }
  }
}

/// Lets Ceres move the variables of `state`, from where they stand.
struct Moved {
  bool converged = true;
  int iterations = 0;
  std::optional<Step> last_step;  // that is left to take
};

/// True where a step would gain less than a thousandth of what the noise makes of the cost: the
/// minimum is a flat valley, and the parameters along it are not determined better than this.
bool is_flat(const LastEvaluation& evaluation, const VariableState& state, const Box& box,
             std::size_t used_values) {
  constexpr double negligible = 1e-3;
  const double variance =
      2 * cost_of(evaluation.system()) / double(std::max<std::size_t>(used_values, 1));
  return gauss_newton_step(evaluation, state, box).gain <= negligible * variance;
}

Moved move_variables(VariableState& state, const Box& box, double precision,
                     std::size_t used_values, LastEvaluation& evaluation, ParameterValues& values) {
  evaluation.move_to(values);
  values = evaluation.values();
  if (state.blocks.empty()) return {};
  const double norm = norm_of_data(evaluation.full_system(), evaluation.values().amplitudes);
  Mover mover(evaluation, state, values, box);
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &mover;
  ceres::Problem problem(problem_options);
  ceres::Solver::Options options = solver_options(state, precision);
  add_blocks(state, evaluation, box, norm > 0 ? 1 / norm : 1, problem, options);
  LastStepCallback last_step(evaluation, state, box, precision, used_values);
  if (evaluation.projectable()) options.callbacks.push_back(&last_step);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  evaluation.move_to(state.values(values, box.amplitudes));
  values = evaluation.values();
  const bool converged = summary.termination_type == ceres::CONVERGENCE ||
                         summary.termination_type == ceres::USER_SUCCESS;
  return {converged || (evaluation.projectable() && is_flat(evaluation, state, box, used_values)),
          std::max(int(summary.iterations.size()) - 1, 0), last_step.step()};
}

/// Takes a step, if it stays in the box: in the shape, and with it in the amplitudes.
void take_step(const Step& step, const VariableState& state, const Box& box, Solution& solution) {
  ParameterValues moved = solution.values;
  const VariableBlock& block = state.blocks.front();
  for (std::size_t v = 0; v < block.size(); ++v) {
    const double x = block[v].from(solution.values) + step.change[Eigen::Index(v)];
    if (!(x >= block[v].lower() && x <= block[v].upper())) return;
    block[v].to(x, moved);
  }
  const AmplitudeSpace& space = box.amplitudes;
  for (std::size_t c = 0; c < solution.system.size(); ++c) {
    const ChannelSystem& system = solution.system[c];
    const auto column = Eigen::Index(c);
    Eigen::VectorXd residuals = system.residuals;
    for (std::size_t v = 0; v < block.size(); ++v) {
      residuals += step.change[Eigen::Index(v)] * block[v].column(system, c, box, solution.values);
    }
    const Eigen::MatrixXd basis = system.amplitude_jacobian * space.map;
    const Eigen::VectorXd now = solution.values.amplitudes(space.free, column);
    const Eigen::VectorXd free = bounded_least_squares(basis, basis * now - residuals,
                                                       box.amplitude_lower(space.free, column),
                                                       box.amplitude_upper(space.free, column));
    moved.amplitudes.col(column) = space.offset + space.map * free;
  }
  solution.values = std::move(moved);
  // At a cost of nothing but roundings the gain may be the larger one.
  solution.cost = std::max(solution.cost - step.gain, 0.0);
}

}  // namespace

Solution solve(const WeightedSamples& samples, const BatchModel& model, const Box& box,
               const ScaledLoss& loss, ParameterValues start, double precision,
               const PassOptions& passes) {
  LastEvaluation evaluation(samples, model, box, loss, passes);
  HeldVariables variables(model.model(), box, samples.channel_count(), evaluation.projectable());
  Solution solution;
  solution.values = std::move(start);
  // Ceres cuts a step off at the box and may then stop though the other parameters could still
  // gain: those at a bound are held, and the rest is solved again, until nothing changes.
  const std::size_t most_rounds = 2 * variables.count() + 2;
  bool settled = false;
  VariableState state;
  Moved moved;
  // A start from a coarser solution stands at the bounds that it ended at.
  evaluation.move_to(solution.values);
  solution.values = evaluation.values();
  variables.update(box, evaluation.system(), solution.values);
  for (std::size_t round = 0; round < most_rounds && !settled; ++round) {
    state = variables.moving(solution.values);
    moved = move_variables(state, box, precision, samples.survey().used_values, evaluation,
                           solution.values);
    solution.converged = moved.converged;
    solution.iterations += moved.iterations;
    settled = !variables.update(box, evaluation.system(), solution.values);
  }
  evaluation.move_to(solution.values);
  solution.values = evaluation.values();
  solution.converged = solution.converged && settled;
  solution.cost = cost_of(evaluation.system());
  solution.system = evaluation.full_system();
  if (moved.last_step) take_step(*moved.last_step, state, box, solution);
  return solution;
}

}  // namespace gonio::fit
