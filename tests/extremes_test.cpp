// The study of bench/extremes in a short form: double and float against 50 digits in every region,
// no number that is none, and a page whose bounds are those measured.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "bench/extremes_page.h"
#include "bench/extremes_regions.h"
#include "bench/extremes_study.h"
#include "bench/finite_study.h"
#include "brdf/terms.h"

namespace gonio::tests {
namespace {

using bench::ModelErrors;
using bench::Verdict;

constexpr std::size_t samples = 150;

/// By another seed than the page's.
const std::vector<ModelErrors>& short_sweep() {
  static const std::vector<ModelErrors> models =
      bench::sweep_extremes({.samples = samples, .seed = 7, .threads = 0});
  return models;
}

/// Enough to write a page from.
const std::vector<ModelErrors>& tiny_sweep() {
  static const std::vector<ModelErrors> models =
      bench::sweep_extremes({.samples = 10, .seed = 7, .threads = 0});
  return models;
}

std::size_t count_lit(const ModelErrors& model) {
  std::size_t count = 0;
  for (const auto& region : model.regions) count += region.in_double.lit;
  return count;
}

TEST(Extremes, EveryTermMeetsItsSamplesInEveryRegion) {
  ASSERT_EQ(short_sweep().size(), std::tuple_size_v<brdf::Terms>);
  for (const ModelErrors& model : short_sweep()) {
    ASSERT_EQ(model.regions.size(), bench::regions().size());
    // Sharp lobes are dark but near the mirror direction; two regions in 14 are all about it.
    EXPECT_GT(count_lit(model), samples * model.regions.size() / 5) << model.name;
  }
}

// The project's figure: 1e-11 relative.
TEST(Extremes, DoubleIsWithinItsFigureOrBoundByItsModelsCondition) {
  for (const ModelErrors& model : short_sweep()) {
    const Verdict verdict = bench::double_verdict(model);
    EXPECT_TRUE(verdict == Verdict::reached ||
                (verdict == Verdict::bound_by_condition && !model.condition.empty()))
        << model.name;
  }
}

// The project's figure: 2e-6 of the peak.
TEST(Extremes, FloatIsWithinItsFigureOrBoundByItsModelsCondition) {
  for (const ModelErrors& model : short_sweep()) {
    const Verdict verdict = bench::float_verdict(model);
    EXPECT_TRUE(verdict == Verdict::reached ||
                (verdict == Verdict::bound_by_condition && !model.condition.empty()))
        << model.name;
  }
}

// Without it a study could compare the stable form with itself.
TEST(Extremes, TheTextbooksFormMissesTheFiguresThatTheStableFormReaches) {
  for (const ModelErrors& model : short_sweep()) {
    // Lambert's has no extremes, and Ward's convenient form is printed with vectors, not angles.
    if (model.name == "lambert" || model.name.substr(0, 11) == "ward-approx") continue;
    EXPECT_GT(bench::worst_of(model, [](const auto& r) { return r.in_float.naive.of_peak; }),
              bench::float_figure)
        << model.name;
  }
}

TEST(Extremes, TheSweepDoesNotDependOnTheNumberOfThreads) {
  const auto one = bench::sweep_extremes({.samples = 3, .seed = 5, .threads = 1});
  const auto four = bench::sweep_extremes({.samples = 3, .seed = 5, .threads = 4});
  for (std::size_t m = 0; m < one.size(); ++m) {
    for (std::size_t r = 0; r < one[m].regions.size(); ++r) {
      EXPECT_EQ(one[m].regions[r].in_double.stable.relative.worst,
                four[m].regions[r].in_double.stable.relative.worst);
      EXPECT_EQ(one[m].regions[r].in_float.stable.of_peak,
                four[m].regions[r].in_float.stable.of_peak);
    }
  }
}

// scripts/extremes makes 1e8 evaluations.
TEST(Extremes, NoEvaluationIsNaNInfiniteOrNegative) {
  const auto models = bench::count_unsound({.evaluations = 100'000, .seed = 3, .threads = 0});
  ASSERT_EQ(models.size(), std::tuple_size_v<brdf::EvaluatedTerms>);
  for (const auto& model : models) {
    for (const auto* count : {&model.in_double, &model.in_float}) {
      EXPECT_EQ(count->evaluations, 100'000U);
      EXPECT_EQ(count->unsound, 0U) << model.name << ": " << count->first;
      EXPECT_GT(count->lit, 20'000U) << model.name << ": the draws miss the lobe";
    }
  }
}

std::string page(const std::vector<ModelErrors>& models) {
  return bench::page_text(models, bench::stated_bounds(models));
}

/// The sweep with every error of one model and region in double times a factor.
std::vector<ModelErrors> with_errors_times(double factor) {
  std::vector<ModelErrors> models = tiny_sweep();
  for (auto& region : models[5].regions) region.in_double.well_conditioned *= factor;
  return models;
}

TEST(ExtremesPage, HoldsForTheStudyItWasWrittenFrom) {
  EXPECT_TRUE(bench::faults_of_text(page(tiny_sweep()), tiny_sweep()).empty());
}

TEST(ExtremesPage, RefusesABoundThatIsTooTight) {
  const auto faults = bench::faults_of_text(page(tiny_sweep()), with_errors_times(20));
  ASSERT_FALSE(faults.empty());
  EXPECT_NE(faults[0].find("`" + tiny_sweep()[5].name + "`: double: "), std::string::npos)
      << faults[0];
}

TEST(ExtremesPage, RefusesABoundThatIsTooWide) {
  EXPECT_FALSE(bench::faults_of_text(page(with_errors_times(100)), tiny_sweep()).empty());
}

TEST(ExtremesPage, RefusesOtherWordsAndNamesTheLine) {
  std::string text = page(tiny_sweep());
  text.replace(text.find("# At"), 4, "# In");
  const auto faults = bench::faults_of_text(text, tiny_sweep());
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].find("line 1: "), std::string::npos) << faults[0];
}

TEST(ExtremesPage, RefusesAMissingRow) {
  std::string text = page(tiny_sweep());
  const std::size_t row = text.find("| `ward` |");
  text.erase(row, text.find('\n', row) + 1 - row);
  const auto faults = bench::faults_of_text(text, tiny_sweep());
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].find("`ward`"), std::string::npos) << faults[0];
}

}  // namespace
}  // namespace gonio::tests
