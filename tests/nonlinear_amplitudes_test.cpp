// Models whose coefficients are not the amplitudes themselves: the compressed problem, the
// projected one and the covariance against plain sums over the samples and against differences.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "fit/fit.h"
#include "fit/joint_system.h"
#include "fit/projection.h"
#include "instrument/synthesize.h"
#include "table/parallel.h"
#include "tests/drawn_recipe.h"
#include "tests/every_metric.h"
#include "tests/plain_model_problem.h"

namespace gonio::tests {
namespace {

/// Everything to look at one noisy table under one metric.
class Problem {
 public:
  Problem(const std::string& name, fit::Metric metric,
          const std::vector<fit::ParameterBounds>& bounds = {})
      : model(name),
        recipe(two_channel_recipe(model, 5)),
        table(instrument::synthesize(recipe)),
        box(fit::box_of(model, table.channels, {.bounds = bounds})),
        plain(model, table, metric),
        samples(table, batch, {.metric = metric},
                fit::survey_of(table, table::SampleFilter(table, 80), 1), plain_floors(table)) {}
  Problem(const Problem&) = delete;
  Problem& operator=(const Problem&) = delete;

  fit::Projected projected(const std::vector<double>& shape, bool with_jacobian) const {
    return fit::project(fit::compress(samples, batch, shape, with_jacobian, {}), batch, box,
                        with_jacobian);
  }

  /// Off the minimum, so that no gradient is 0.
  fit::ParameterValues somewhere() const {
    fit::ParameterValues values = truth_of(recipe, model);
    for (double& x : values.shape) x *= 0.93;
    values.amplitudes *= 0.9;
    return values;
  }

  brdf::Model model;
  fit::BatchModel batch{model};
  instrument::Recipe recipe;
  table::SampleTable table;
  fit::Box box;
  PlainModelProblem plain;
  fit::WeightedSamples samples;
};

class NonlinearAmplitudes : public testing::TestWithParam<std::string> {};

TEST_P(NonlinearAmplitudes, ProjectedCostIsTheLeastOfAllTheSamples) {
  for (const fit::Metric metric :
       {fit::Metric::l2, fit::Metric::cosine_l2, fit::Metric::relative, fit::Metric::chi2}) {
    const Problem problem(GetParam(), metric);
    fit::ParameterValues values = problem.somewhere();
    const fit::Projected projected = problem.projected(values.shape, false);
    values.amplitudes = projected.amplitudes;
    const auto cost = [&](const fit::ParameterValues& at) {
      return problem.plain.cost(fit::Loss::none, 1, at);
    };
    const double least = cost(values);
    EXPECT_NEAR(fit::cost_of(projected.system), least, 1e-12 * least);
    for (const fit::Unknown& unknown : fit::unknowns_of(problem.model, problem.table.channels)) {
      if (unknown.is_shape) continue;
      const double value = values[unknown];
      const double slope = derivative_of(cost, unknown, values);
      // A step of the whole amplitude would change the cost by its slope, were that not 0.
      const double size = 1e-8 * least / std::max(value, 1e-2);
      if (value > problem.box.lower(unknown)) {
        EXPECT_LE(slope, size) << unknown.name << " " << value;
      }
      if (value < problem.box.upper(unknown)) {
        EXPECT_GE(slope, -size) << unknown.name << " " << value;
      }
    }
  }
}

void expect_exact_gradient(const Problem& problem, const std::string& what) {
  fit::ParameterValues values = problem.somewhere();
  const fit::Projected projected = problem.projected(values.shape, true);
  const auto cost_at = [&](const fit::ParameterValues& at) {
    return fit::cost_of(problem.projected(at.shape, false).system);
  };
  for (const fit::Unknown& unknown : fit::unknowns_of(problem.model, problem.table.channels)) {
    if (!unknown.is_shape) continue;
    double gradient = 0;
    double size = 0;
    for (const fit::ChannelSystem& channel : projected.system) {
      const auto column = channel.shape_jacobian.col(Eigen::Index(unknown.index));
      gradient += column.dot(channel.residuals);
      size += column.norm() * channel.residuals.norm();
    }
    EXPECT_NEAR(gradient, derivative_of(cost_at, unknown, values), 1e-8 * size)
        << what << " " << unknown.name;
    EXPECT_GT(size, 0) << what << " " << unknown.name;
  }
}

TEST_P(NonlinearAmplitudes, ProjectedJacobianHasTheExactGradient) {
  for (const fit::Metric metric :
       {fit::Metric::l2, fit::Metric::cosine_l2, fit::Metric::relative, fit::Metric::chi2}) {
    expect_exact_gradient(Problem(GetParam(), metric), std::string(fit::name(metric)));
  }
}

TEST_P(NonlinearAmplitudes, ProjectedJacobianHasTheExactGradientWithAmplitudesAtBounds) {
  // Every amplitude of the first channel is pressed against a bound, each in its turn.
  const brdf::Model model(GetParam());
  for (const brdf::ModelParameter& p : model.amplitudes()) {
    const double truth = two_channel_recipe(model, 5).parameters.at(p.name).front();
    const std::vector<fit::ParameterBounds> bounds{{p.name + ".R", 0, 0.5 * truth}};
    const Problem problem(GetParam(), fit::Metric::l2, bounds);
    expect_exact_gradient(problem, p.name);
    EXPECT_EQ(problem.projected(problem.somewhere().shape, false)
                  .amplitudes(&p - model.amplitudes().data(), 0),
              0.5 * truth);
  }
}

TEST_P(NonlinearAmplitudes, JointSystemHasTheCostAndTheGradientOfAllTheSamples) {
  for (const fit::Metric metric : all_metrics) {
    const Problem problem(GetParam(), metric);
    const fit::ParameterValues values = problem.somewhere();
    std::vector<double> magnitudes = problem.plain.residuals(values);
    for (double& r : magnitudes) r = std::abs(r);
    for (const fit::Loss loss : all_losses) {
      const double scale = loss == fit::Loss::none ? 1 : 1.5 * plain_median(magnitudes);
      const fit::LinearSystem system =
          fit::joint_system_of(problem.samples, problem.batch, values, {loss, scale}, {});
      const auto cost_at = [&](const fit::ParameterValues& at) {
        return problem.plain.cost(loss, scale, at);
      };
      const double cost = cost_at(values);
      EXPECT_NEAR(fit::cost_of(system), cost, 1e-12 * cost);
      for (const fit::Unknown& unknown : fit::unknowns_of(problem.model, problem.table.channels)) {
        double gradient = 0;
        double size = 0;
        for (std::size_t c = 0; c < system.size(); ++c) {
          if (!unknown.is_shape && unknown.channel != c) continue;
          const auto column =
              (unknown.is_shape ? system[c].shape_jacobian : system[c].amplitude_jacobian)
                  .col(Eigen::Index(unknown.index));
          gradient += column.dot(system[c].residuals);
          size += column.norm() * system[c].residuals.norm();
        }
        // The third derivative of tukey's and huber's loss jumps: a residual within a step of the
        // scale errs by the step, 1e-4, of its share.
        const double tolerance = loss == fit::Loss::none || loss == fit::Loss::cauchy ? 1e-7 : 1e-4;
        EXPECT_NEAR(gradient, derivative_of(cost_at, unknown, values), tolerance * size)
            << fit::name(metric) << " " << fit::name(loss) << " " << unknown.name;
        EXPECT_GT(size, 0) << unknown.name;
      }
    }
  }
}

/// d residual / d unknown by differences, [value, unknown].
Eigen::MatrixXd plain_jacobian(const PlainModelProblem& plain, const fit::FitResult& result) {
  const auto residuals_at = [&](const fit::ParameterValues& at) -> Eigen::VectorXd {
    const std::vector<double> residuals = plain.residuals(at);
    return Eigen::Map<const Eigen::VectorXd>(residuals.data(), Eigen::Index(residuals.size()));
  };
  Eigen::MatrixXd jacobian(Eigen::Index(plain.values().size()),
                           Eigen::Index(result.unknowns.size()));
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    jacobian.col(Eigen::Index(u)) = derivative_of(residuals_at, result.unknowns[u], result.values);
  }
  return jacobian;
}

/// Half the width of sigma's interval of one standard deviation, which is that of its square; else
/// the standard deviation.
double reported_deviation(const fit::FitResult& result, const fit::Unknown& unknown,
                          double deviation) {
  if (unknown.parameter != "sigma") return deviation;
  const double value = result.values[unknown];
  const double of_square = 2 * value * deviation;
  return (std::sqrt(value * value + of_square) -
          std::sqrt(std::max(value * value - of_square, 0.0))) /
         2;
}

void expect_covariance(const fit::FitResult& result, const Eigen::MatrixXd& expected,
                       double tolerance) {
  const Eigen::MatrixXd& covariance = result.uncertainty.covariance;
  for (Eigen::Index a = 0; a < expected.rows(); ++a) {
    ASSERT_TRUE(result.uncertainty.stddev[std::size_t(a)].has_value());
    const double deviation = std::sqrt(expected(a, a));
    EXPECT_NEAR(*result.uncertainty.stddev[std::size_t(a)],
                reported_deviation(result, result.unknowns[std::size_t(a)], deviation),
                tolerance * deviation);
    for (Eigen::Index b = 0; b < expected.cols(); ++b) {
      EXPECT_NEAR(covariance(a, b), expected(a, b),
                  tolerance * std::sqrt(expected(a, a) * expected(b, b)))
          << result.unknowns[std::size_t(a)].name << " " << result.unknowns[std::size_t(b)].name;
    }
  }
}

TEST_P(NonlinearAmplitudes, CovarianceWithKnownSigmaIsTheInverseOfTheJacobiansSquare) {
  const Problem problem(GetParam(), fit::Metric::chi2);
  const fit::FitResult result =
      fit::fit(problem.model, problem.table,
               {.metric = fit::Metric::chi2, .covariance = fit::Covariance::known_sigma});
  const Eigen::MatrixXd jacobian = plain_jacobian(problem.plain, result);
  // Differences err by 1e-11, times the square of the condition, about 1e2.
  expect_covariance(result, (jacobian.transpose() * jacobian).inverse(), 1e-6);
}

TEST_P(NonlinearAmplitudes, SandwichIsTheSumOfTheScoresOfTheSamples) {
  for (const fit::Loss loss : {fit::Loss::none, fit::Loss::cauchy}) {
    const Problem problem(GetParam(), fit::Metric::cosine_l2);
    const fit::FitResult result = fit::fit(
        problem.model, problem.table,
        {.metric = fit::Metric::cosine_l2, .loss = loss, .covariance = fit::Covariance::sandwich});
    const Eigen::MatrixXd jacobian = plain_jacobian(problem.plain, result);
    const std::vector<double> residuals = problem.plain.residuals(result.values);
    const Eigen::Index count = jacobian.cols();
    Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(Eigen::Index(problem.table.size()), count);
    Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(count, count);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      // Cauchy's rho' = 1 / (1 + s), and rho' + 2 s rho'' = (1 - s) / (1 + s)^2.
      const double s = loss == fit::Loss::none ? 0 : std::pow(residuals[i] / result.loss_scale, 2);
      const auto row = jacobian.row(Eigen::Index(i));
      scores.row(Eigen::Index(problem.plain.values()[i].sample)) += residuals[i] / (1 + s) * row;
      curvature += (1 - s) / ((1 + s) * (1 + s)) * row.transpose() * row;
    }
    const Eigen::MatrixXd bread = curvature.inverse();
    const double n = double(residuals.size());
    const double clusters = double(result.used);
    const double factor = clusters / (clusters - 1) * (n - 1) / (n - double(count));
    expect_covariance(result, factor * bread * scores.transpose() * scores * bread, 1e-6);
  }
}

std::string identifier(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Of, NonlinearAmplitudes,
                         testing::Values("strauss", "strauss-listing", "ashikhmin-shirley",
                                         "ashikhmin-shirley-aniso", "oren-nayar-full",
                                         "lambert+ashikhmin-shirley", "oren-nayar-full+ward",
                                         "oren-nayar-full+ashikhmin-shirley"),
                         [](const auto& instance) { return identifier(instance.param); });

class CoverageOfNonlinearAmplitudes : public testing::TestWithParam<std::string> {};

TEST_P(CoverageOfNonlinearAmplitudes, IsNineteenOfTwenty) {
  constexpr std::size_t repetitions = 300;
  const brdf::Model model(GetParam());
  instrument::Recipe recipe = two_channel_recipe(model, 5);
  recipe.noise.relative = 0.02;
  const fit::ParameterValues truth = truth_of(recipe, model);
  const std::size_t count = fit::unknowns_of(model, recipe.channels).size();
  std::vector<std::vector<char>> inside(repetitions, std::vector<char>(count));
  table::parallel_for(repetitions, 0, [&](std::size_t repetition) {
    instrument::Recipe noisy = recipe;
    noisy.noise.seed = 1000 + repetition;
    const fit::FitResult result =
        fit::fit(model, instrument::synthesize(noisy), {.metric = fit::Metric::chi2, .threads = 1});
    for (std::size_t u = 0; u < count; ++u) {
      const auto& interval = result.uncertainty.interval95[u];
      const double value = truth[result.unknowns[u]];
      inside[repetition][u] = interval && interval->first <= value && value <= interval->second;
    }
  });
  // Chance leaves a parameter whose true coverage is 95 % outside these once in 1e4 studies: they
  // are 90 % and 99 %.
  const boost::math::binomial distribution(double(repetitions), 0.95);
  const double least = boost::math::quantile(distribution, 5e-5);
  const double most = boost::math::quantile(boost::math::complement(distribution, 5e-5));
  const std::vector<fit::Unknown> unknowns = fit::unknowns_of(model, recipe.channels);
  std::string shares;
  for (std::size_t u = 0; u < count; ++u) {
    double covered = 0;
    for (const std::vector<char>& of_fit : inside) covered += of_fit[u];
    EXPECT_GE(covered, least) << unknowns[u].name;
    EXPECT_LE(covered, most) << unknowns[u].name;
    shares += fmt::format("  {} {:.1f} %", unknowns[u].name, 100 * covered / repetitions);
  }
  std::printf("%s:%s\n", GetParam().c_str(), shares.c_str());
}

INSTANTIATE_TEST_SUITE_P(Of, CoverageOfNonlinearAmplitudes,
                         testing::Values("strauss", "ashikhmin-shirley", "oren-nayar-full"),
                         [](const auto& instance) { return identifier(instance.param); });

}  // namespace
}  // namespace gonio::tests
