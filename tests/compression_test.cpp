// The compressed problem is the whole problem: same residual norms, same solutions, same gradient.
#include "fit/compression.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <random>

#include "fit/bounded_least_squares.h"
#include "fit/projection.h"
#include "instrument/synthesize.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

table::SampleTable two_channel_table() {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "ward-aniso");
  recipe.channels = {"R", "G"};
  recipe.parameters["rho_d"] = {0.1, 0.2};
  recipe.parameters["rho_s"] = {0.33, 0.1};
  recipe.noise = {.relative = 0.05, .floor = 1e-2, .seed = 11};
  recipe.sigma_columns = true;
  return instrument::synthesize(recipe);
}

/// The plain way: every row of [B y], weighted, for one channel.
struct Dense {
  Eigen::MatrixXd basis;
  Eigen::VectorXd values;
};

Dense dense_problem(const table::SampleTable& table, const brdf::Model& model,
                    const std::vector<double>& shape, std::size_t channel, fit::Metric metric) {
  const table::SampleFilter filter(table, 80);
  std::vector<std::array<double, 3>> rows;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!filter(i)) continue;
    std::array<double, 2> basis{};
    model.basis(shape, table.wi[i], table.wo[i], basis);
    const double factor = metric == fit::Metric::chi2        ? 1 / table.sigma[channel][i]
                          : metric == fit::Metric::cosine_l2 ? table.wi.z[i]
                                                             : 1.0;
    rows.push_back({factor * basis[0], factor * basis[1], factor * table.values[channel][i]});
  }
  Dense dense{Eigen::MatrixXd(Eigen::Index(rows.size()), 2),
              Eigen::VectorXd(Eigen::Index(rows.size()))};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    dense.basis.row(Eigen::Index(r)) << rows[r][0], rows[r][1];
    dense.values[Eigen::Index(r)] = rows[r][2];
  }
  return dense;
}

fit::WeightedSamples samples_of(const table::SampleTable& table, const fit::BatchModel& batch,
                                const fit::Options& options) {
  const table::SampleFilter filter(table, options.max_theta_deg);
  return {table, batch, options, fit::survey_of(table, filter, 1),
          fit::relative_floors(table, filter, 1)};
}

class CompressionUnder : public testing::TestWithParam<fit::Metric> {};

TEST_P(CompressionUnder, GivesTheDenseProblemsSolutionAndCost) {
  const table::SampleTable table = two_channel_table();
  const brdf::Model model("ward-aniso");
  const fit::BatchModel batch(model);
  const fit::Options options{.metric = GetParam()};
  const fit::WeightedSamples samples = samples_of(table, batch, options);
  const std::vector<double> shape{0.05, 0.16};  // the truth: no bound is active
  const fit::Compressed compressed = fit::compress(samples, batch, shape, true, {});
  const fit::Projected projected =
      fit::project(compressed, batch, fit::box_of(model, table.channels, options), true);
  double cost = 0;
  for (std::size_t c = 0; c < 2; ++c) {
    const Dense dense = dense_problem(table, model, shape, c, GetParam());
    const Eigen::VectorXd amplitudes = dense.basis.colPivHouseholderQr().solve(dense.values);
    // Two backward-stable solutions of a problem of condition about 30.
    EXPECT_LE((projected.amplitudes.col(Eigen::Index(c)) - amplitudes).norm(),
              1e-12 * amplitudes.norm());
    cost += (dense.basis * amplitudes - dense.values).squaredNorm() / 2;
  }
  EXPECT_NEAR(fit::cost_of(projected.system), cost, 1e-12 * cost);
}

TEST_P(CompressionUnder, GivesTheExactGradientOfTheProjectedCost) {
  const table::SampleTable table = two_channel_table();
  const brdf::Model model("ward-aniso");
  const fit::BatchModel batch(model);
  // A bound that is active in one channel: its amplitude does not follow the shape.
  const fit::Options options{.metric = GetParam(), .bounds = {{"rho_s.R", 0, 0.2}}};
  const fit::WeightedSamples samples = samples_of(table, batch, options);
  const fit::Box box = fit::box_of(model, table.channels, options);
  const auto cost_at = [&](double alpha_x, double alpha_y) {
    return fit::cost_of(
        fit::project(fit::compress(samples, batch, std::array{alpha_x, alpha_y}, false, {}), batch,
                     box, false)
            .system);
  };
  const double ax = 0.07;
  const double ay = 0.2;
  const fit::Projected projected =
      fit::project(fit::compress(samples, batch, std::array{ax, ay}, true, {}), batch, box, true);
  EXPECT_EQ(projected.amplitudes(1, 0), 0.2);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(2);
  for (const fit::ChannelSystem& channel : projected.system) {
    gradient += channel.shape_jacobian.transpose() * channel.residuals;
  }
  // Central differences: the truncation error is of the order h^2, the rounding of 1e-16 / h.
  const double h = 1e-6;
  EXPECT_NEAR(gradient[0], (cost_at(ax + h, ay) - cost_at(ax - h, ay)) / (2 * h),
              1e-6 * std::abs(gradient[0]));
  EXPECT_NEAR(gradient[1], (cost_at(ax, ay + h) - cost_at(ax, ay - h)) / (2 * h),
              1e-6 * std::abs(gradient[1]));
}

INSTANTIATE_TEST_SUITE_P(Metric, CompressionUnder,
                         testing::Values(fit::Metric::l2, fit::Metric::cosine_l2,
                                         fit::Metric::chi2));

TEST(Compression, DoesNoHarmToARankDeficientProblem) {
  const table::SampleTable table = two_channel_table();
  const brdf::Model model("ward-aniso");
  const fit::BatchModel batch(model);
  const fit::Options options{.metric = fit::Metric::l2, .fixed = {{"rho_s", 0}}};
  const fit::WeightedSamples samples = samples_of(table, batch, options);
  const fit::Projected projected =
      fit::project(fit::compress(samples, batch, std::array{1e-4, 1e-4}, true, {}), batch,
                   fit::box_of(model, table.channels, options), true);
  for (const fit::ChannelSystem& channel : projected.system) {
    EXPECT_TRUE(channel.residuals.allFinite());
    EXPECT_TRUE((channel.shape_jacobian.array() == 0).all());
  }
}

TEST(BoundedLeastSquares, FindsTheMinimumOfABox) {
  // The minimum over a box is no worse than any point of a fine grid in it.
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::MatrixXd matrix(4, 3);
    Eigen::VectorXd rhs(4);
    for (double& x : matrix.reshaped()) x = uniform(random);
    for (double& x : rhs) x = uniform(random);
    const Eigen::VectorXd lower{{0, -0.2, 0.1}};
    const Eigen::VectorXd upper{{std::numeric_limits<double>::infinity(), 0.3, 0.1}};
    const Eigen::VectorXd x = fit::bounded_least_squares(matrix, rhs, lower, upper);
    ASSERT_TRUE((x.array() >= lower.array()).all() && (x.array() <= upper.array()).all());
    const double cost = (matrix * x - rhs).squaredNorm();
    for (int a = 0; a <= 100; ++a) {
      for (int b = 0; b <= 50; ++b) {
        const Eigen::VectorXd other{{a * 0.1, -0.2 + b * 0.01, 0.1}};
        ASSERT_LE(cost, (matrix * other - rhs).squaredNorm() + 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace gonio::tests
