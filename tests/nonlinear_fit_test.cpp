// Whole fits of the models whose coefficients are not the amplitudes themselves: none ends above
// what a simplex finds that knows nothing but the cost, written down plainly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "tests/drawn_recipe.h"
#include "tests/nelder_mead.h"
#include "tests/plain_model_problem.h"

namespace gonio::tests {
namespace {

std::string identifier(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

/// Goes on for as long as that helps, from a small simplex about the lowest point again and again.
template <class Function>
LowestPoint patient_nelder_mead(const Function& function, const Eigen::VectorXd& start,
                                double share, int rounds) {
  LowestPoint lowest{start, function(start)};
  for (int round = 0; round < rounds; ++round) {
    const Eigen::VectorXd steps = share * lowest.x.cwiseAbs().cwiseMax(1e-2);
    lowest = nelder_mead(function, lowest.x, steps, 400);
    share /= 4;
  }
  return lowest;
}

/// The search for a lower cost than a fit found, over its free unknowns and within its box.
class LowerCost {
 public:
  LowerCost(const fit::FitResult& result, const table::SampleTable& table,
            const fit::Options& options)
      : result_(result),
        box_(fit::box_of(result.model, table.channels, options)),
        problem_(result.model, table, options.metric),
        scale_(options.loss == fit::Loss::none ? 1 : result.loss_scale) {}

  /// The values where the point's coordinates are the free unknowns.
  fit::ParameterValues values_at(const Eigen::VectorXd& point) const {
    fit::ParameterValues values = result_.values;
    Eigen::Index next = 0;
    for (const fit::Unknown& u : result_.unknowns) {
      if (u.fixed || u.dependent) continue;
      place_of(u, values) = std::clamp(point[next++], box_.lower(u), box_.upper(u));
    }
    const fit::AmplitudeSpace& space = box_.amplitudes;
    const Eigen::MatrixXd free = values.amplitudes(space.free, Eigen::all);
    values.amplitudes = (space.map * free).colwise() + space.offset;
    return values;
  }

  Eigen::VectorXd point_of(const fit::ParameterValues& values) const {
    std::vector<double> point;
    for (const fit::Unknown& u : result_.unknowns) {
      if (!u.fixed && !u.dependent) point.push_back(values[u]);
    }
    return Eigen::Map<const Eigen::VectorXd>(point.data(), Eigen::Index(point.size()));
  }

  double cost(const Eigen::VectorXd& point) const {
    return problem_.cost(result_.loss, scale_, values_at(point));
  }

  /// From the fit itself, from the truth, and from the best of many random points.
  LowestPoint search(const fit::ParameterValues& truth, std::uint64_t seed) const {
    const auto function = [&](const Eigen::VectorXd& point) { return cost(point); };
    std::vector<LowestPoint> found{patient_nelder_mead(function, point_of(result_.values), 1e-3, 1),
                                   patient_nelder_mead(function, point_of(truth), 0.1, 3)};
    std::vector<LowestPoint> random;
    for (int i = 0; i < 100; ++i) {
      const auto point = point_of(
          truth_of(two_channel_recipe(result_.model, seed + std::uint64_t(i)), result_.model));
      random.push_back({point, function(point)});
    }
    const auto is_lower = [](const LowestPoint& a, const LowestPoint& b) {
      return a.value < b.value;
    };
    std::sort(random.begin(), random.end(), is_lower);
    for (std::size_t i = 0; i < 2; ++i) {
      found.push_back(patient_nelder_mead(function, random[i].x, 0.3, 2));
    }
    return *std::min_element(found.begin(), found.end(), is_lower);
  }

 private:
  const fit::FitResult& result_;
  fit::Box box_;
  PlainModelProblem problem_;
  double scale_;
};

std::string text_of(const fit::FitResult& result, const fit::ParameterValues& values) {
  std::string text;
  for (const fit::Unknown& u : result.unknowns) {
    text += fmt::format(" {}={:.6g}", u.name, values[u]);
  }
  return text;
}

/// Expects that no simplex ends below the fit. The readings are `gain` times too high.
fit::FitResult expect_least_cost(const brdf::Model& model, const instrument::Recipe& recipe,
                                 const fit::Options& options, double gain = 1) {
  table::SampleTable table = instrument::synthesize(recipe);
  for (std::vector<double>& channel : table.values) {
    for (double& value : channel) value *= gain;
  }
  fit::FitResult result = fit::fit(model, table, options);
  EXPECT_TRUE(result.converged);
  const LowerCost lower(result, table, options);
  const double own = lower.cost(lower.point_of(result.values));
  EXPECT_NEAR(result.cost, own, 1e-9 * own) << "the cost is not that of the values";
  const LowestPoint lowest = lower.search(truth_of(recipe, model), recipe.noise.seed + 100);
  EXPECT_LE(result.cost, (1 + 1e-9) * lowest.value)
      << "fit:" << text_of(result, result.values)
      << "\nlower:" << text_of(result, lower.values_at(lowest.x));
  return result;
}

struct Criterion {
  fit::Metric metric;
  fit::Loss loss;
};

class NonlinearFit : public testing::TestWithParam<std::tuple<std::string, Criterion>> {};

TEST_P(NonlinearFit, EndsNowhereAboveASimplex) {
  const auto& [name, criterion] = GetParam();
  const brdf::Model model(name);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    instrument::Recipe recipe = two_channel_recipe(model, seed);
    recipe.noise.relative = 0.02;
    SCOPED_TRACE(fmt::format("table {}", seed));
    expect_least_cost(model, recipe, {.metric = criterion.metric, .loss = criterion.loss});
  }
}

INSTANTIATE_TEST_SUITE_P(
    Every, NonlinearFit,
    testing::Combine(testing::Values("strauss", "ashikhmin-shirley", "ashikhmin-shirley-aniso",
                                     "oren-nayar-full", "lambert+ashikhmin-shirley",
                                     "oren-nayar-full+ward"),
                     testing::Values(Criterion{fit::Metric::l2, fit::Loss::none},
                                     Criterion{fit::Metric::cosine_l2, fit::Loss::none},
                                     Criterion{fit::Metric::log, fit::Loss::none},
                                     // The noise is a share of the value: under others the lobe's
                                     // is beyond the scale, and cauchy's cost has many minima.
                                     Criterion{fit::Metric::relative, fit::Loss::cauchy})),
    [](const auto& instance) {
      const Criterion& c = std::get<1>(instance.param);
      return identifier(fmt::format("{}_{}_{}", std::get<0>(instance.param), fit::name(c.metric),
                                    fit::name(c.loss)));
    });

/// Ashikhmin-Shirley's model with the given shares and noise of 3 %.
instrument::Recipe coupled_recipe(const std::vector<double>& rd, const std::vector<double>& rs,
                                  std::uint64_t seed) {
  instrument::Recipe recipe = two_channel_recipe(brdf::Model("ashikhmin-shirley"), seed);
  recipe.parameters["Rd"] = rd;
  recipe.parameters["Rs"] = rs;
  recipe.parameters["n"] = {40};
  recipe.noise.relative = 0.03;
  return recipe;
}

TEST(NonlinearFitAtBounds, OfWhiteMaterialsAndOfMetalsIsTheLeastThereIs) {
  const brdf::Model model("ashikhmin-shirley");
  // A twentieth too bright: more than a surface without loss can send back.
  constexpr double gain = 1.05;
  for (const std::uint64_t seed : {1U, 2U}) {
    for (const fit::Metric metric : {fit::Metric::l2, fit::Metric::log}) {
      SCOPED_TRACE(fmt::format("seed {} {}", seed, fit::name(metric)));
      const fit::FitResult white = expect_least_cost(
          model, coupled_recipe({1, 0.99}, {0.04, 0.3}, seed), {.metric = metric}, gain);
      EXPECT_TRUE((white.values.amplitudes.row(0).array() == 1).all()) << white.values.amplitudes;
      const fit::FitResult metal = expect_least_cost(
          model, coupled_recipe({0.5, 1}, {1, 0.99}, seed), {.metric = metric}, gain);
      EXPECT_TRUE((metal.values.amplitudes.colwise().maxCoeff().array() == 1).all())
          << metal.values.amplitudes;
    }
  }
}

TEST(NonlinearFitWithFixes, IsTheLeastThereIs) {
  const auto expect_least = [](const char* name, const fit::Options& options) {
    const brdf::Model model(name);
    for (const fit::Metric metric : {fit::Metric::cosine_l2, fit::Metric::log}) {
      SCOPED_TRACE(fmt::format("{} {}", name, fit::name(metric)));
      fit::Options with_metric = options;
      with_metric.metric = metric;
      const fit::FitResult result =
          expect_least_cost(model, two_channel_recipe(model, 3), with_metric);
      for (const fit::ParameterSetting& fixed : options.fixed) {
        for (const fit::Unknown& u : result.unknowns) {
          if (u.name != fixed.parameter && u.parameter != fixed.parameter) continue;
          EXPECT_EQ(result.values[u], fixed.value);
          EXPECT_TRUE(u.fixed);
        }
      }
    }
  };
  expect_least("strauss", {.fixed = {{"t", 0}}});
  expect_least("strauss", {.fixed = {{"c.R", 0.5}}});
  expect_least("ashikhmin-shirley", {.fixed = {{"Rs", 0.05}}});
  expect_least("ashikhmin-shirley", {.fixed = {{"Rd.R", 0.3}}});
  expect_least("ashikhmin-shirley", {.fixed = {{"Rd", 0.2}}, .bounds = {{"Rs", 0.3, 0.5}}});
  expect_least("oren-nayar-full", {.fixed = {{"sigma", 0.3}}});
  expect_least("oren-nayar-full+ward", {.fixed = {{"rho_d.G", 0.4}}});
}

TEST(NonlinearFitWithFixes, OfAHomogeneousMaterialKeepsToTheFullFormsSquare) {
  const brdf::Model model("oren-nayar-full+ward");
  instrument::Recipe recipe = two_channel_recipe(model, 2);
  recipe.parameters["rho_d"] = {0.7, 0.85};
  recipe.parameters["rho_s"] = {0.3, 0.15};
  const fit::FitResult result = expect_least_cost(model, recipe, {.homogeneous = true});
  EXPECT_TRUE((result.values.amplitudes.colwise().sum().array() == 1).all())
      << result.values.amplitudes;
}

TEST(NonlinearFitWithFixes, OfNoRhoDAndRhoSIsNotHomogeneous) {
  for (const char* name : {"strauss", "strauss-listing", "ashikhmin-shirley", "oren-nayar-full",
                           "ashikhmin-shirley-aniso", "lambert+ashikhmin-shirley",
                           "oren-nayar+phong", "oren-nayar-full+ward+ward"}) {
    const brdf::Model model(name);
    EXPECT_THROW(fit::box_of(model, std::vector<std::string>{"Y"}, {.homogeneous = true}),
                 std::invalid_argument)
        << name;
  }
}

}  // namespace
}  // namespace gonio::tests
