// The median in rounds against sorting, and the robust scale and the outliers of a fit against
// plain computations.
#include "fit/median.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "fit/fit.h"
#include "fit/robust_scale.h"
#include "instrument/synthesize.h"
#include "tests/plain_problem.h"
#include "tests/ward_materials.h"

namespace gonio::tests {
namespace {

using Numbers = std::vector<double>;
using Times = std::vector<std::uint64_t>;

constexpr double tolerance = 1e-7;

/// The (lower) median of numbers that count so many times each, by sorting.
double sorted_median(const Numbers& numbers, const Times& times) {
  std::vector<std::size_t> order(numbers.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
  std::uint64_t total = 0;
  for (const std::uint64_t t : times) total += t;
  std::uint64_t rank = (total - 1) / 2;
  for (const std::size_t i : order) {
    if (rank < times[i]) return numbers[i];
    rank -= times[i];
  }
  return NAN;
}

struct Found {
  double value;
  int rounds;
};

/// In three parts, added in reverse order.
Found found_median(const Numbers& numbers, const Times* times, double lower, double upper) {
  fit::MedianSearch search(lower, upper, tolerance);
  int rounds = 0;
  for (; !search.done(); ++rounds) {
    const std::size_t third = numbers.size() / 3;
    const std::array<std::size_t, 4> ends{0, third, 2 * third, numbers.size()};
    for (std::size_t part = 3; part-- > 0;) {
      fit::MedianSearch::Counts counts = search.counts();
      const std::size_t count = ends[part + 1] - ends[part];
      const auto some = std::span(numbers).subspan(ends[part], count);
      if (times == nullptr) {
        counts.add(some);
      } else {
        counts.add(some, std::span(*times).subspan(ends[part], count));
      }
      search.add(counts);
    }
    search.end_round();
  }
  return {search.value(), rounds};
}

/// Brackets that hold the median, miss it on either side, are empty, or far too wide.
std::vector<std::pair<double, double>> brackets(double median, double largest) {
  return {{0, 0},
          {0.8 * median, 1.25 * median},
          {2 * median, 3 * median},
          {0.1 * median, 0.2 * median},
          {median, median},
          {0, 10 * largest}};
}

struct Distribution {
  std::string name;
  std::function<double(std::mt19937_64&)> draw;
};

std::vector<Distribution> distributions() {
  const auto unit = [](std::mt19937_64& random) {
    return std::uniform_real_distribution<double>(0, 1)(random);
  };
  return {
      {"constant", [](std::mt19937_64& /*random*/) { return 0.7; }},
      {"normal",
       [](std::mt19937_64& random) {
         return std::abs(std::normal_distribution<double>()(random));
       }},
      {"bimodal",
       [unit](std::mt19937_64& random) {
         return (unit(random) < 0.5 ? 1e-3 : 1e3) * (1 + 0.01 * unit(random));
       }},
      {"two values", [unit](std::mt19937_64& random) { return unit(random) < 0.5 ? 1.0 : 2.0; }},
      {"a third zeros",
       [unit](std::mt19937_64& random) {
         return unit(random) < 0.33 ? 0.0 : std::exp(-unit(random));
       }},
      {"twenty decades",
       [unit](std::mt19937_64& random) { return std::pow(10, -15 + 20 * unit(random)); }},
      {"outliers of 1e12",
       [unit](std::mt19937_64& random) {
         return unit(random) < 0.4 ? 1e12 * unit(random) : 1e-6 * (1 + unit(random));
       }},
      {"quantised", [unit](std::mt19937_64& random) { return std::floor(20 * unit(random)) / 64; }},
  };
}

TEST(MedianInRounds, IsTheOneThatSortingFinds) {
  for (const Distribution& distribution : distributions()) {
    for (const std::size_t count : {1U, 2U, 3U, 10U, 1001U, 20000U}) {
      std::mt19937_64 random(count);
      Numbers numbers(count);
      for (double& x : numbers) x = distribution.draw(random);
      const double expected = plain_median(numbers);
      const double largest = *std::max_element(numbers.begin(), numbers.end());
      for (const auto& [lower, upper] : brackets(expected, largest)) {
        const Found found = found_median(numbers, nullptr, lower, upper);
        EXPECT_NEAR(found.value, expected, tolerance * expected)
            << distribution.name << ", " << count << " in " << lower << " .. " << upper;
      }
    }
  }
}

TEST(MedianInRounds, CountsNumbersAsManyTimesAsItIsTold) {
  for (const Distribution& distribution : distributions()) {
    std::mt19937_64 random(5);
    Numbers numbers(3000);
    Times times(numbers.size());
    for (double& x : numbers) x = distribution.draw(random);
    for (std::uint64_t& t : times) t = random() % 65536;
    const double expected = sorted_median(numbers, times);
    const double largest = *std::max_element(numbers.begin(), numbers.end());
    for (const auto& [lower, upper] : brackets(expected, largest)) {
      EXPECT_NEAR(found_median(numbers, &times, lower, upper).value, expected, tolerance * expected)
          << distribution.name << " in " << lower << " .. " << upper;
    }
  }
}

TEST(MedianInRounds, TakesTwoWhereTheBracketIsGood) {
  // A bracket of 0.4 of the median is 1e-7 of it wide after two divisions by 2048.
  std::mt19937_64 random(2);
  Numbers numbers(10000);
  for (double& x : numbers) x = std::abs(std::normal_distribution<double>()(random));
  const double median = plain_median(numbers);
  EXPECT_EQ(found_median(numbers, nullptr, 0.82 * median, 1.2 * median).rounds, 2);
}

TEST(MedianInRounds, OfNothingIsZero) { EXPECT_EQ(found_median({}, nullptr, 0, 1).value, 0); }

TEST(MedianInRounds, OfZerosIsZeroToRounding) {
  const Numbers numbers(100, 0.0);
  EXPECT_LE(found_median(numbers, nullptr, 0, 0).value, 1e-100);
  EXPECT_LE(found_median(numbers, nullptr, 0.5, 2).value, 1e-100);
}

// The scale of a fit.

/// 2 % + 1e-3 noise, and 2 % of the readings 20 times too high.
table::SampleTable table_with_outliers(std::string_view model, double noise) {
  instrument::Recipe recipe = ward_recipe(ward_materials[5], model);
  recipe.channels = {"R", "G"};
  recipe.parameters["rho_d"] = {0.19, 0.25};
  recipe.parameters["rho_s"] = {0.043, 0.06};
  recipe.noise = {.relative = noise, .floor = noise / 20, .seed = 4};
  table::SampleTable table = instrument::synthesize(recipe);
  std::mt19937_64 random(9);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (random() % 50 != 0) continue;
    for (std::vector<double>& channel : table.values) channel[i] *= 20;
  }
  return table;
}

Numbers magnitudes_of(const table::SampleTable& table, fit::Metric metric,
                      const fit::ParameterValues& parameters) {
  Numbers magnitudes;
  for (const PlainValue& value : plain_values(table, plain_floors(table))) {
    magnitudes.push_back(std::abs(double(value.residual(metric, plain(parameters)))));
  }
  return magnitudes;
}

TEST(RobustDeviation, IsTheMedianOfTheResidualsWithTheTablesWeights) {
  table::SampleTable table = table_with_outliers("ward-aniso", 0.02);
  const brdf::Model model("ward-aniso");
  const fit::BatchModel batch(model);
  fit::ParameterValues parameters{{0.07, 0.09}, Eigen::MatrixXd(2, 2)};
  parameters.amplitudes << 0.2, 0.24, 0.05, 0.05;
  for (const bool with_weights : {false, true}) {
    Numbers weights;
    if (with_weights) {
      // Whole 65,536ths of the largest, as which they are counted.
      std::mt19937_64 random(1);
      for (std::size_t i = 0; i < table.size(); ++i) {
        weights.push_back(i == 0 ? 1 : double(random() % 65536 + 1) / 65536);
      }
      table.weight = weights;
    }
    for (const fit::Metric metric :
         {fit::Metric::l2, fit::Metric::cosine_l2, fit::Metric::log, fit::Metric::cube_root}) {
      const table::SampleFilter filter(table, 80);
      const fit::WeightedSamples samples(table, batch, {.metric = metric},
                                         fit::survey_of(table, filter, 1));
      Numbers magnitudes;
      Times times;
      for (const PlainValue& value : plain_values(table, plain_floors(table))) {
        magnitudes.push_back(std::abs(double(value.residual(metric, plain(parameters)))));
        times.push_back(with_weights ? std::uint64_t(value.weight * 65536) : 1);
      }
      const double expected = 1.482602218505602 * sorted_median(magnitudes, times);
      for (const double near : {0.0, 0.9 * expected, 10 * expected}) {
        EXPECT_NEAR(fit::robust_deviation(samples, batch, parameters, near, 0, {}), expected,
                    2e-7 * expected)
            << fit::name(metric) << (with_weights ? " with weights" : "") << " near " << near;
      }
    }
  }
}

TEST(RobustDeviation, TakesTwoPassesWhereItIsNearlyKnown) {
  const table::SampleTable table = table_with_outliers("ward-aniso", 0.02);
  const brdf::Model model("ward-aniso");
  const fit::BatchModel batch(model);
  fit::ParameterValues parameters{{0.07, 0.09}, Eigen::MatrixXd(2, 2)};
  parameters.amplitudes << 0.2, 0.24, 0.05, 0.05;
  const table::SampleFilter filter(table, 80);
  const fit::WeightedSamples samples(table, batch, {.metric = fit::Metric::cosine_l2},
                                     fit::survey_of(table, filter, 1));
  const double deviation = fit::robust_deviation(samples, batch, parameters, 0, 0, {});
  for (const double near : {0.85, 1.0, 1.15}) {
    int passes = 0;
    const auto on_pass = [&]() -> std::function<void(double)> {
      ++passes;
      return nullptr;
    };
    fit::robust_deviation(samples, batch, parameters, near * deviation, 0,
                          {.threads = 1, .on_pass = on_pass});
    EXPECT_EQ(passes, 2) << "within a fifth of " << near;
  }
}

class AFoundScale : public testing::TestWithParam<std::tuple<fit::Metric, fit::Loss>> {};

TEST_P(AFoundScale, IsThatOfTheFinalResidualsAndOutliersAreThoseBeyondIt) {
  const auto [metric, loss] = GetParam();
  const table::SampleTable table = table_with_outliers("ward-aniso", 0.02);
  const fit::FitResult result =
      fit::fit(brdf::Model("ward-aniso"), table, {.metric = metric, .loss = loss});
  EXPECT_TRUE(result.converged);
  const Numbers magnitudes = magnitudes_of(table, metric, result.values);
  const double deviation = 1.482602218505602 * plain_median(magnitudes);
  // Holland & Welsch 1977, table 1.
  const double efficient = loss == fit::Loss::huber    ? 1.345
                           : loss == fit::Loss::cauchy ? 2.385
                                                       : 4.685;
  // The precision that options.h promises.
  EXPECT_NEAR(result.loss_scale, efficient * deviation, 1e-3 * result.loss_scale);
  EXPECT_NEAR(result.outlier_threshold, 5 * deviation, 1e-3 * result.outlier_threshold);
  const auto beyond =
      std::size_t(std::count_if(magnitudes.begin(), magnitudes.end(),
                                [&](double r) { return r > result.outlier_threshold; }));
  EXPECT_EQ(result.outlier_count, beyond);
  EXPECT_GE(beyond, 50u) << "2 % of the values are spoilt";
  ASSERT_EQ(result.outliers.size(), std::min(beyond, fit::most_outliers));
  for (std::size_t k = 1; k < result.outliers.size(); ++k) {
    EXPECT_GE(std::abs(result.outliers[k - 1].residual), std::abs(result.outliers[k].residual));
  }
  const fit::Outlier& worst = result.outliers.front();
  const std::vector<PlainValue> values = plain_values(table, plain_floors(table));
  for (const PlainValue& value : values) {
    if (value.sample != worst.sample || value.channel != worst.channel) continue;
    EXPECT_NEAR(worst.residual, -double(value.residual(metric, plain(result.values))),
                1e-9 * std::abs(worst.residual));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Every, AFoundScale,
    testing::Combine(testing::Values(fit::Metric::l2, fit::Metric::cosine_l2, fit::Metric::log,
                                     fit::Metric::cube_root, fit::Metric::relative),
                     testing::Values(fit::Loss::huber, fit::Loss::cauchy, fit::Loss::tukey)),
    [](const auto& instance) {
      std::string name(fit::name(std::get<0>(instance.param)));
      name += "_" + std::string(fit::name(std::get<1>(instance.param)));
      for (char& c : name) {
        if (c == '-') c = '_';
      }
      return name;
    });

}  // namespace
}  // namespace gonio::tests
