// The compressed problem in amplitudes and shape is the whole one, for every metric and loss: cost,
// gradient and curvature against one plain loop over all the samples (plain_problem.h).
#include "fit/joint_system.h"

#include <ceres/loss_function.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "tests/every_metric.h"
#include "tests/plain_problem.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

/// Two channels, noise, sigma, weights, holes, masked samples, and every 50th value 20 times too
/// high. More than 4,096 rows: several tasks of eight chunks each.
table::SampleTable table_with_everything() {
  instrument::Recipe recipe = ward_recipe(ward_materials[0], "ward-aniso");
  recipe.channels = {"R", "G"};
  recipe.parameters["rho_d"] = {0.1, 0.2};
  recipe.parameters["rho_s"] = {0.33, 0.1};
  recipe.theta_max_deg = 85;
  recipe.hemisphere = {.theta_step_deg = 5, .phi_step_deg = 20};
  recipe.noise = {.relative = 0.05, .floor = 1e-2, .seed = 11};
  recipe.sigma_columns = true;
  table::SampleTable table = instrument::synthesize(recipe);
  std::mt19937_64 random(3);
  for (std::size_t i = 0; i < table.size(); ++i) {
    table.weight.push_back(0.25 + double(random() % 1000) / 500);
    if (i % 7 == 0) table.values[0][i] = std::nan("");
    if (i % 50 == 1) table.values[1][i] *= 20;
    if (i % 31 == 2) table.mask[i] = table::MaskReason::extrapolated;
    if (i % 910 == 3) table.values[1][i] = 0;
  }
  return table;
}

/// Off the minimum, so that the gradient is not 0.
fit::ParameterValues some_values() {
  fit::ParameterValues values{{0.07, 0.13, 0.2}, Eigen::MatrixXd(2, 2)};
  values.amplitudes << 0.12, 0.17, 0.3, 0.12;
  return values;
}

/// A scale that many residuals are beyond, others within.
double middling_scale(const std::vector<PlainValue>& values, fit::Metric metric) {
  std::vector<double> magnitudes;
  for (const PlainValue& value : values) {
    magnitudes.push_back(std::abs(double(value.residual(metric, plain(some_values())))));
  }
  return 1.5 * plain_median(magnitudes);
}

/// The unknowns of a channel's rows: rho_d and rho_s of the channel, alpha_x, alpha_y, psi.
constexpr Eigen::Index unknown_count = 5;

PlainParameters moved(PlainParameters p, std::size_t channel, Eigen::Index unknown,
                      long double by) {
  const std::array<long double*, unknown_count> places{&p.rho_d[channel], &p.rho_s[channel],
                                                       &p.alpha_x, &p.alpha_y, &p.psi};
  *places[std::size_t(unknown)] += by;
  return p;
}

/// Central differences of long doubles. A residual of the lobe's peak moves by some 1e3 h, of which
/// tukey's scale, 1e-2, may be small: truncation (1e5 h)^2 = 1e-6 of such a value's part; rounding
/// 1e-19 / h = 1e-11.
constexpr long double step = 1e-8L;

/// The loss of a squared residual; Ceres counts twice the cost.
std::shared_ptr<ceres::LossFunction> ceres_loss(fit::Loss loss, double scale) {
  switch (loss) {
    case fit::Loss::none:
      break;
    case fit::Loss::huber:
      return std::make_shared<ceres::HuberLoss>(scale);
    case fit::Loss::cauchy:
      return std::make_shared<ceres::CauchyLoss>(scale);
    case fit::Loss::tukey:
      return std::make_shared<ceres::TukeyLoss>(scale);
  }
  return std::make_shared<ceres::TrivialLoss>();
}

using Curvature = Eigen::Matrix<double, unknown_count, unknown_count>;

/// J'J of one channel, each row weighed by the loss' rho' at its residual, and by the second
/// derivative of the loss by the residual, rho' + 2 s rho''.
struct PlainCurvature {
  Curvature weights = Curvature::Zero();
  Curvature loss = Curvature::Zero();
};

PlainCurvature plain_curvature(const std::vector<PlainValue>& values, fit::Metric metric,
                               fit::Loss loss, long double scale, std::size_t channel,
                               const PlainParameters& p) {
  std::array<std::array<PlainParameters, 2>, unknown_count> around;
  for (Eigen::Index u = 0; u < unknown_count; ++u) {
    around[std::size_t(u)] = {moved(p, channel, u, step), moved(p, channel, u, -step)};
  }
  const std::shared_ptr<ceres::LossFunction> of_ceres = ceres_loss(loss, double(scale));
  PlainCurvature sum;
  for (const PlainValue& value : values) {
    if (value.channel != channel) continue;
    const auto square = double(std::pow(value.residual(metric, p), 2));
    std::array<double, 3> rho{};
    of_ceres->Evaluate(square, rho.data());
    Eigen::Matrix<double, unknown_count, 1> row;
    for (Eigen::Index u = 0; u < unknown_count; ++u) {
      const auto& [above, below] = around[std::size_t(u)];
      row[u] = double((value.residual(metric, above) - value.residual(metric, below)) / (2 * step));
    }
    sum.weights += value.weight * rho[1] * row * row.transpose();
    sum.loss += value.weight * (rho[1] + 2 * square * rho[2]) * row * row.transpose();
  }
  return sum;
}

/// The loss' curvature, in the directions where it is less than a fiftieth of the weights' raised
/// to that: a step must not go uphill.
Curvature positive_part(const PlainCurvature& curvature) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Curvature> eigen(curvature.loss,
                                                                  curvature.weights);
  const Curvature back = curvature.weights * eigen.eigenvectors();
  return back * eigen.eigenvalues().cwiseMax(0.02).cwiseMin(1).asDiagonal() * back.transpose();
}

/// The largest difference of two matrices in units of the sizes of their columns.
double difference(const Curvature& a, const Curvature& b) {
  const Eigen::VectorXd sizes = b.diagonal().cwiseSqrt();
  return ((a - b).array() / (sizes * sizes.transpose()).array()).abs().maxCoeff();
}

class JointSystemUnder : public testing::TestWithParam<std::tuple<fit::Metric, fit::Loss>> {
 protected:
  JointSystemUnder() {
    const table::SampleFilter filter(measured, 80);
    const std::vector<double> floors = fit::relative_floors(measured, filter, 1);
    all_values = plain_values(measured, floors);
    loss_scale = loss == fit::Loss::none ? 1 : middling_scale(all_values, metric);
    const fit::WeightedSamples samples(measured, batch, {.metric = metric},
                                       fit::survey_of(measured, filter, 1), floors);
    compressed = fit::joint_system_of(samples, batch, some_values(), {loss, loss_scale}, {});
  }

  fit::Metric metric = std::get<0>(GetParam());
  fit::Loss loss = std::get<1>(GetParam());
  table::SampleTable measured = table_with_everything();
  brdf::Model fitted_model{"ward-aniso", brdf::Frame::free};
  fit::BatchModel batch{fitted_model};
  std::vector<PlainValue> all_values;
  double loss_scale = 1;
  fit::LinearSystem compressed;
};

TEST_P(JointSystemUnder, HasTheCostOfAllTheSamples) {
  ASSERT_GT(measured.size(), 4096u);
  const auto expected =
      double(plain_cost(all_values, metric, loss, loss_scale, plain(some_values())));
  // 10,000 values, exponents of 1e-14 in the brightest.
  EXPECT_NEAR(fit::cost_of(compressed), expected, 1e-12 * expected);
}

TEST_P(JointSystemUnder, HasTheGradientOfAllTheSamples) {
  const PlainParameters p = plain(some_values());
  for (std::size_t c = 0; c < 2; ++c) {
    std::vector<PlainValue> of_channel;
    std::copy_if(all_values.begin(), all_values.end(), std::back_inserter(of_channel),
                 [&](const PlainValue& value) { return value.channel == c; });
    const fit::ChannelSystem& system = compressed[c];
    Eigen::VectorXd gradient(unknown_count);
    gradient << system.amplitude_jacobian.transpose() * system.residuals,
        system.shape_jacobian.transpose() * system.residuals;
    for (Eigen::Index u = 0; u < unknown_count; ++u) {
      const auto cost_at = [&](long double by) {
        return plain_cost(of_channel, metric, loss, loss_scale, moved(p, c, u, by));
      };
      const auto expected = double((cost_at(step) - cost_at(-step)) / (2 * step));
      // A sum of signed products, of which only the largest have the truncation above.
      const double size =
          (u < 2 ? system.amplitude_jacobian.col(u) : system.shape_jacobian.col(u - 2)).norm() *
          system.residuals.norm();
      EXPECT_NEAR(gradient[u], expected, 1e-8 * size) << "channel " << c << " unknown " << u;
    }
  }
}

TEST_P(JointSystemUnder, HasTheCurvatureOfAllTheSamplesAtTheMinimum) {
  fit::Options options{.metric = metric, .loss = loss};
  if (loss != fit::Loss::none) options.loss_scale = loss_scale;
  const fit::ParameterValues minimum = fit::fit(fitted_model, measured, options).values;
  const table::SampleFilter filter(measured, 80);
  const fit::WeightedSamples samples(measured, batch, {.metric = metric},
                                     fit::survey_of(measured, filter, 1),
                                     fit::relative_floors(measured, filter, 1));
  const fit::LinearSystem system =
      fit::joint_system_of(samples, batch, minimum, {loss, loss_scale}, {});
  // The relative metric may leave a noisy channel without a lobe, and so without curvature by the
  // shape.
  EXPECT_GT(minimum.amplitudes(1, 0), 0);
  for (std::size_t c = 0; c < 2; ++c) {
    if (minimum.amplitudes(1, Eigen::Index(c)) == 0) continue;
    const PlainCurvature expected =
        plain_curvature(all_values, metric, loss, loss_scale, c, plain(minimum));
    Eigen::MatrixXd jacobian(system[c].residuals.size(), unknown_count);
    jacobian << system[c].amplitude_jacobian, system[c].shape_jacobian;
    const Curvature curvature = jacobian.transpose() * jacobian;
    // The Jacobian's differences, as above; a direction that is nearly flat in one of them.
    EXPECT_LE(
        difference(curvature, loss == fit::Loss::none ? expected.weights : positive_part(expected)),
        1e-6)
        << "channel " << c;
  }
}

TEST_P(JointSystemUnder, HasTheCurvatureOfTheWeightsOrOfTheLossElsewhere) {
  for (std::size_t c = 0; c < 2; ++c) {
    const PlainCurvature expected =
        plain_curvature(all_values, metric, loss, loss_scale, c, plain(some_values()));
    Eigen::MatrixXd jacobian(compressed[c].residuals.size(), unknown_count);
    jacobian << compressed[c].amplitude_jacobian, compressed[c].shape_jacobian;
    const Curvature curvature = jacobian.transpose() * jacobian;
    EXPECT_LE(std::min(difference(curvature, expected.weights),
                       difference(curvature, positive_part(expected))),
              1e-6)
        << "channel " << c;
  }
}

TEST_P(JointSystemUnder, HasTheSameBitsForAnyNumberOfThreads) {
  const table::SampleFilter filter(measured, 80);
  const fit::WeightedSamples samples(measured, batch, {.metric = metric},
                                     fit::survey_of(measured, filter, 1),
                                     fit::relative_floors(measured, filter, 1));
  for (const int threads : {2, 7}) {
    const fit::LinearSystem other = fit::joint_system_of(
        samples, batch, some_values(), {loss, loss_scale}, {.threads = threads, .on_pass = {}});
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_EQ(other[c].residuals, compressed[c].residuals);
      EXPECT_EQ(other[c].amplitude_jacobian, compressed[c].amplitude_jacobian);
      EXPECT_EQ(other[c].shape_jacobian, compressed[c].shape_jacobian);
    }
  }
}

TEST_P(JointSystemUnder, HasAFewRowsHoweverManySamplesThereAre) {
  for (const fit::ChannelSystem& channel : compressed) {
    EXPECT_EQ(channel.residuals.size(), unknown_count + 1);
    EXPECT_TRUE(channel.residuals.allFinite() && channel.amplitude_jacobian.allFinite() &&
                channel.shape_jacobian.allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(Every, JointSystemUnder,
                         testing::Combine(testing::ValuesIn(all_metrics),
                                          testing::ValuesIn(all_losses)),
                         [](const auto& instance) { return name_of(instance); });

TEST(ScaledLoss, IsTheOneOfCeres) {
  // Ceres takes the square of the residual and a scale; rho[0..2] are the loss and its derivatives.
  const double scale = 0.3;
  for (const fit::Loss loss : all_losses) {
    const std::shared_ptr<ceres::LossFunction> expected = ceres_loss(loss, scale);
    for (double r = 1e-5; r < 1e5; r *= 1.0637) {
      const double square = r * r;
      std::array<double, 3> rho{};
      expected->Evaluate(square, rho.data());
      const auto value = fit::ScaledLoss{loss, scale}(square / (scale * scale));
      const auto packed = fit::ScaledLoss{loss, scale}(brdf::Pack(square / (scale * scale)));
      const double influence = rho[1] + 2 * square * rho[2];
      // 1 - (1 - s)^3 loses what is below 1e-16; the influence, a difference, the same.
      EXPECT_NEAR(value.rho * scale * scale, rho[0], 1e-14 * rho[0] + 1e-17) << fit::name(loss);
      EXPECT_NEAR(value.slope, rho[1], 1e-14 * rho[1]) << fit::name(loss) << " " << r;
      EXPECT_NEAR(value.influence, influence, 1e-14 * rho[1] + 1e-15)
          << fit::name(loss) << " " << r;
      for (std::size_t lane = 0; lane < brdf::Pack::size; ++lane) {
        EXPECT_NEAR(packed.rho[lane], value.rho, 1e-15 * value.rho + 1e-17);
        EXPECT_NEAR(packed.slope[lane], value.slope, 1e-15 * value.slope);
        EXPECT_NEAR(packed.influence[lane], value.influence, 1e-15);
      }
    }
  }
}

TEST(JointSystem, StaysFiniteForResidualsFarBeyondTheScale) {
  const table::SampleTable table = table_with_everything();
  const brdf::Model model("ward-aniso", brdf::Frame::free);
  const fit::BatchModel batch(model);
  const table::SampleFilter filter(table, 80);
  const fit::WeightedSamples samples(table, batch, {.metric = fit::Metric::l2},
                                     fit::survey_of(table, filter, 1));
  for (const fit::Loss loss : {fit::Loss::huber, fit::Loss::cauchy, fit::Loss::tukey}) {
    for (const double scale : {1e-300, 1e-160, 1e-20, 1e20, 1e160, 1e300}) {
      for (const fit::ChannelSystem& channel :
           fit::joint_system_of(samples, batch, some_values(), {loss, scale}, {})) {
        EXPECT_TRUE(channel.residuals.allFinite()) << fit::name(loss) << " " << scale;
        EXPECT_TRUE(channel.shape_jacobian.allFinite()) << fit::name(loss) << " " << scale;
      }
    }
  }
}

}  // namespace
}  // namespace gonio::tests
