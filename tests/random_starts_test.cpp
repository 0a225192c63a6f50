// Where a search starts does not matter: from a hundred random starts a fit ends at the same
// minimum, under every metric and loss. Beside it, how many of them reach it without the search;
// none of those ends any lower.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "fit/amplitudes.h"
#include "fit/fit.h"
#include "fit/solve.h"
#include "instrument/synthesize.h"
#include "table/parallel.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

constexpr std::size_t start_count = 100;

struct Case {
  const char* name;
  std::size_t material;  // of Ward's table
  const char* model;
  double alpha;  // instead of the material's, if above 0
  fit::Metric metric;
  fit::Loss loss;
};

/// About 500 samples; for a narrow lobe the patch about the mirror direction is as narrow.
table::SampleTable table_of(const Case& c) {
  instrument::Recipe recipe = ward_recipe(ward_materials[c.material], c.model);
  recipe.incidence_angles_deg = {20, 55};
  recipe.sample_rotations_deg = {0, 90};
  recipe.hemisphere = {.theta_step_deg = 20, .phi_step_deg = 45};
  recipe.noise = {.relative = 0.02, .floor = 1e-3, .seed = 13};
  recipe.sigma_columns = true;
  if (c.alpha > 0) {
    recipe.parameters["alpha"] = {c.alpha};
    recipe.mirror_patch->radius_step_deg = 0.3;
    recipe.mirror_patch->radius_max_deg = 2.4;
  }
  return instrument::synthesize(recipe);
}

/// Log-uniform in the inner 90 % of the roughness' bounds.
std::vector<std::vector<double>> random_shapes(const brdf::Model& model) {
  std::mt19937_64 random(77);
  std::vector<std::vector<double>> shapes(start_count);
  for (std::vector<double>& shape : shapes) {
    for (const brdf::ModelParameter& parameter : model.shape()) {
      const double share = 0.05 + 0.9 * double(random() >> 11) * 0x1p-53;
      shape.push_back(parameter.descriptor.lower *
                      std::pow(parameter.descriptor.upper / parameter.descriptor.lower, share));
    }
  }
  return shapes;
}

/// The same minimum: the cost to 1e-9, the roughness to 1e-6.
bool is_same(double cost, const fit::ParameterValues& values, const fit::FitResult& best) {
  bool same = std::abs(cost - best.cost) <= 1e-9 * best.cost;
  for (std::size_t j = 0; j < values.shape.size(); ++j) {
    same = same && std::abs(values.shape[j] / best.values.shape[j] - 1) <= 1e-6;
  }
  return same;
}

/// How many starts end at `best` by a fit that is told the start.
std::size_t reached_by_fits(const brdf::Model& model, const table::SampleTable& table,
                            const fit::Options& options,
                            const std::vector<std::vector<double>>& shapes,
                            const fit::FitResult& best) {
  std::atomic<std::size_t> reached = 0;
  table::parallel_for(shapes.size(), 0, [&](std::size_t i) {
    fit::Options with_start = options;
    with_start.threads = 1;
    for (std::size_t j = 0; j < shapes[i].size(); ++j) {
      with_start.start.push_back({model.shape()[j].name, shapes[i][j]});
    }
    const fit::FitResult result = fit::fit(model, table, with_start);
    reached += result.converged && is_same(result.cost, result.values, best) ? 1 : 0;
  });
  return reached;
}

struct WithoutSearch {
  std::size_t reached;
  double least_cost;
};

/// The same from the start alone, with the best amplitudes at it.
WithoutSearch without_search(const brdf::Model& model, const table::SampleTable& table,
                             const fit::Options& options,
                             const std::vector<std::vector<double>>& shapes,
                             const fit::FitResult& best) {
  const fit::BatchModel batch(model);
  const table::SampleFilter filter(table, options.max_theta_deg);
  const fit::Box box = fit::box_of(model, table.channels, options);
  const fit::WeightedSamples samples(table, batch, options, fit::survey_of(table, filter, 1),
                                     fit::relative_floors(table, filter, 1));
  std::vector<fit::SampleChunk> chunks;
  for (std::size_t i = 0; i < samples.chunk_count(); ++i) {
    chunks.emplace_back(samples.channel_count());
    samples.gather(i, chunks.back());
  }
  const fit::ScaledLoss loss{options.loss, options.loss == fit::Loss::none ? 1 : best.loss_scale};
  std::vector<fit::Solution> solutions(shapes.size());
  table::parallel_for(shapes.size(), 0, [&](std::size_t i) {
    const fit::ShapeCost start =
        fit::best_amplitudes(samples, chunks, batch, box, shapes[i], options.loss);
    solutions[i] = fit::solve(samples, batch, box, loss, {shapes[i], start.amplitudes},
                              fit::final_precision, {});
  });
  WithoutSearch result{0, std::numeric_limits<double>::infinity()};
  for (const fit::Solution& solution : solutions) {
    result.reached += is_same(solution.cost, solution.values, best) ? 1 : 0;
    result.least_cost = std::min(result.least_cost, solution.cost);
  }
  return result;
}

class RandomStarts : public testing::TestWithParam<Case> {};

TEST_P(RandomStarts, AllLeadToTheSameMinimum) {
  const Case& c = GetParam();
  const brdf::Model model(c.model);
  const table::SampleTable table = table_of(c);
  fit::Options options{.metric = c.metric, .loss = c.loss};
  const fit::FitResult best = fit::fit(model, table, options);
  // With a scale of its own every start would have another problem to solve.
  if (c.loss != fit::Loss::none) options.loss_scale = best.loss_scale;
  const std::vector<std::vector<double>> shapes = random_shapes(model);
  const WithoutSearch alone = without_search(model, table, options, shapes, best);
  EXPECT_GE(alone.least_cost, best.cost * (1 - 1e-9)) << "the search missed the global minimum";
  const std::size_t reached = reached_by_fits(model, table, options, shapes, best);
  EXPECT_EQ(reached, start_count);
  RecordProperty("reached", int(reached));
  RecordProperty("reached_without_search", int(alone.reached));
  std::printf("%-26s %-9s %-6s %3zu of %zu random starts, %3zu without the search\n", c.name,
              std::string(fit::name(c.metric)).c_str(), std::string(fit::name(c.loss)).c_str(),
              reached, start_count, alone.reached);
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const fit::Metric metric :
       {fit::Metric::l2, fit::Metric::cosine_l2, fit::Metric::log, fit::Metric::cube_root,
        fit::Metric::relative, fit::Metric::chi2}) {
    all.push_back({"ivory_plastic", 8, "ward", 0, metric, fit::Loss::none});
    all.push_back({"lightly_brushed_aluminum", 2, "ward-aniso", 0, metric, fit::Loss::none});
    all.push_back({"narrow_lobe", 7, "ward", 0.012, metric, fit::Loss::none});
  }
  for (const fit::Loss loss : {fit::Loss::huber, fit::Loss::cauchy, fit::Loss::tukey}) {
    all.push_back({"lightly_brushed_aluminum", 2, "ward-aniso", 0, fit::Metric::cosine_l2, loss});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Every, RandomStarts, testing::ValuesIn(cases()), [](const auto& instance) {
  const Case& c = instance.param;
  std::string name = std::string(c.name) + "_" + std::string(fit::name(c.metric)) + "_" +
                     std::string(fit::name(c.loss));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace gonio::tests
