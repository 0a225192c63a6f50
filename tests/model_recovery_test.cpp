// Every model finds its own parameters again in a table that was made with them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fit/fit.h"
#include "instrument/synthesize.h"
#include "tests/drawn_recipe.h"

namespace gonio::tests {
namespace {

/// The largest relative error of a parameter that the directions determine.
double worst_error(const fit::FitResult& result, const instrument::Recipe& recipe,
                   std::string& where) {
  double worst = 0;
  for (std::size_t u = 0; u < result.unknowns.size(); ++u) {
    const fit::Unknown& unknown = result.unknowns[u];
    if (!result.uncertainty.stddev[u]) continue;
    const std::vector<double>& truths = recipe.parameters.at(unknown.parameter);
    const double truth = truths[unknown.is_shape ? 0 : unknown.channel];
    const double error = std::abs(result.values[unknown] - truth) / truth;
    if (error > worst)
      where = fmt::format("{} {} for {}", unknown.name, result.values[unknown], truth);
    worst = std::max(worst, error);
  }
  return worst;
}

std::size_t determined(const fit::FitResult& result) {
  return std::size_t(std::count_if(result.uncertainty.stddev.begin(),
                                   result.uncertainty.stddev.end(),
                                   [](const auto& stddev) { return stddev.has_value(); }));
}

class EveryModel : public testing::TestWithParam<std::string> {};

TEST_P(EveryModel, IsRecoveredFromNoiseFreeTables) {
  const brdf::Model model(GetParam());
  const int truths = model.shape().size() < 3 ? 20 : 100;
  RecipeDraw draw(2024);
  int found = 0;
  double worst = 0;
  for (int truth = 0; truth < truths; ++truth) {
    const instrument::Recipe recipe = draw.recipe(model);
    const table::SampleTable table = instrument::synthesize(recipe);
    const fit::Metric metric = truth % 2 == 0 ? fit::Metric::l2 : fit::Metric::cosine_l2;
    const fit::FitResult result = fit::fit(model, table, {.metric = metric});
    std::string where;
    const double error = worst_error(result, recipe, where);
    const bool is_found = error <= 1e-7 && determined(result) == result.unknowns.size();
    found += is_found ? 1 : 0;
    if (is_found) {
      worst = std::max(worst, error);
    } else {
      std::printf("%s, truth %d: %s, %zu of %zu determined\n", GetParam().c_str(), truth,
                  where.c_str(), determined(result), result.unknowns.size());
      for (const auto& [name, values] : recipe.parameters)
        std::printf("  %s %s", name.c_str(), fmt::format("{}", values.front()).c_str());
      std::printf("\n");
    }
  }
  // The figures: all, and of Strauss' at least 99 of 100.
  EXPECT_GE(found, truths - (truths >= 100 ? 1 : 0));
  std::printf("%-24s %3d of %3d truths recovered, worst relative error %.1e\n", GetParam().c_str(),
              found, truths, worst);
}

INSTANTIATE_TEST_SUITE_P(Recovery, EveryModel, testing::ValuesIn(brdf::model_names()),
                         [](const auto& instance) {
                           std::string name = instance.param;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) { return std::isalnum(c) == 0; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace gonio::tests
