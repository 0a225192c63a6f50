// gonio fit beyond plain least squares: every metric and loss, and the outliers that they name.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "instrument/synthesize.h"
#include "tests/fit_command.h"
#include "tests/json_schema.h"

namespace gonio::tests {
namespace {

using nlohmann::json;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

// Metrics and losses --------------------------------------------------------------------------

TEST(FitCommand, EveryMetricAndLossIsFittedAndNamedInTheResult) {
  const Schema schema("material.schema.json");
  for (const std::string metric : {"l2", "cosine-l2", "log", "cube-root", "relative", "chi2"}) {
    for (const std::string loss : {"none", "huber", "cauchy", "tukey"}) {
      SCOPED_TRACE(metric + " " + loss);
      const json material = json_of({plastic, "-m", "ward", "--metric", metric, "--loss", loss});
      EXPECT_EQ(schema.complaint(material), "");
      const json& result = material.at("fit");
      EXPECT_EQ(result.at("metric"), metric);
      EXPECT_EQ(result.at("loss"), loss);
      EXPECT_EQ(result.contains("loss_scale"), loss != "none");
      EXPECT_EQ(result.contains("outliers"), loss != "none");
      // Ward's plastic. 2 % noise on 1696 samples leaves the estimates within 0.2 %, whatever the
      // weighting.
      for (const auto& [name, value] :
           {std::pair{"rho_d", 0.45}, {"rho_s", 0.043}, {"alpha", 0.13}}) {
        EXPECT_NEAR(value_of(material, name) / value, 1, 0.005) << name;
      }
    }
  }
}

TEST(FitCommand, EachMetricIsSmallestWhereItIsMinimised) {
  const std::vector<std::string> metrics{"l2", "cosine-l2", "log", "cube-root", "relative"};
  // An isotropic lobe does not describe brushed brass: each metric has its own best one.
  std::map<std::string, json> errors;
  for (const std::string& metric : metrics) {
    errors[metric] = json_of({brass, "-m", "ward", "--metric", metric}).at("fit").at("errors");
  }
  for (const std::string& metric : metrics) {
    for (const std::string& other : metrics) {
      if (other == metric) continue;
      EXPECT_LT(errors[metric].at(metric), errors[other].at(metric)) << metric << ", " << other;
    }
  }
}

TEST(FitCommand, AGivenLossScaleIsTakenAsItIs) {
  const json material =
      json_of({brass, "-m", "ward-aniso", "--loss", "huber", "--loss-scale", "0.0125"});
  EXPECT_EQ(material.at("fit").at("loss_scale"), 0.0125);
  const CommandResult given =
      fit({brass, "-m", "ward-aniso", "--loss", "huber", "--loss-scale", "0.0125"});
  EXPECT_THAT(given.out, HasSubstr("loss huber at 0.0125 (given)"));
  EXPECT_THAT(fit({brass, "-m", "ward-aniso", "--loss", "huber"}).out,
              ContainsRegex("loss huber at 0\\.0[0-9]+ \\(found\\)"));
}

TEST(FitCommand, ALossIsTheSameForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  std::vector<std::string> outputs, files;
  for (const std::string threads : {"1", "2"}) {
    const std::string residuals = folder / (threads + ".csv");
    const CommandResult result = fit({brass, "-m", "ward-aniso,ward", "--metric", "log", "--loss",
                                      "cauchy", "--threads", threads, "--residuals", residuals});
    EXPECT_EQ(result.exit_status, 0) << result.err;
    outputs.push_back(result.out);
    files.push_back(content_of(residuals));
    json material = json_of({brass, "-m", "ward-aniso", "--loss", "tukey", "--threads", threads});
    material.erase("timing");
    material.at("provenance").erase("command");
    outputs.back() += material.dump();
  }
  EXPECT_EQ(outputs[0], outputs[1]);
  EXPECT_EQ(files[0], files[1]);
}

// Outliers ------------------------------------------------------------------------------------

/// Rolled brass with 2 % noise, and every 50th sample, 2 % of them, 20 times too bright.
struct TableWithOutliers {
  table::SampleTable table;
  std::set<std::size_t> corrupted;
};

TableWithOutliers brass_with_outliers() {
  instrument::Recipe recipe = brass_recipe();
  // The noise is relative, but for what a sigma above 0 needs: all residuals of metric relative
  // scatter alike.
  recipe.noise = {.relative = 0.02, .floor = 1e-6, .seed = 7};
  recipe.sigma_columns = true;
  TableWithOutliers result{instrument::synthesize(recipe), {}};
  for (std::size_t i = 7; i < result.table.size(); i += 50) {
    result.table.values[0][i] *= 20;
    result.corrupted.insert(i);
  }
  return result;
}

std::set<std::size_t> listed_samples(const json& material) {
  std::set<std::size_t> samples;
  for (const json& outlier : material.at("fit").at("outliers").at("listed")) {
    EXPECT_EQ(outlier.at("channel"), "Y");
    EXPECT_GT(outlier.at("residual").get<double>(), 0);  // measured less fitted: too bright
    samples.insert(outlier.at("sample").get<std::size_t>());
  }
  return samples;
}

TEST(FitCommand, OutliersPullThePlainFitFarOffAndARobustOneNot) {
  const TemporaryFolder folder;
  const auto [table, corrupted] = brass_with_outliers();
  const std::string path = write_table(folder, "outliers.csv", table);
  const std::vector<std::string> chi2{path, "-m", "ward-aniso", "--metric", "chi2"};
  EXPECT_GT(worst_error(json_of(chi2)), 0.1);
  for (const std::string loss : {"cauchy", "tukey"}) {
    std::vector<std::string> robust = chi2;
    robust.insert(robust.end(), {"--loss", loss});
    // A standard deviation of the estimates is below 0.1 %; a few of them.
    EXPECT_LT(worst_error(json_of(robust)), 0.005) << loss;
  }
}

TEST(FitCommand, ListsExactlyTheCorruptedSamplesAsOutliers) {
  const TemporaryFolder folder;
  const auto [table, corrupted] = brass_with_outliers();
  const std::string path = write_table(folder, "outliers.csv", table);
  // 5 standard deviations of normal noise: of 1900 samples 0.001 would pass.
  for (const std::string metric : {"chi2", "relative"}) {
    const json material =
        json_of({path, "-m", "ward-aniso", "--metric", metric, "--loss", "cauchy"});
    EXPECT_EQ(listed_samples(material), corrupted) << metric;
    EXPECT_EQ(material.at("fit").at("outliers").at("count"), corrupted.size()) << metric;
  }
  const CommandResult text =
      fit({path, "-m", "ward-aniso", "--metric", "relative", "--loss", "cauchy"});
  EXPECT_THAT(text.out,
              HasSubstr(fmt::format("outliers: {} of {} values", corrupted.size(), table.size())));
  const CommandResult clean =
      fit({brass, "-m", "ward-aniso", "--metric", "chi2", "--loss", "cauchy"});
  EXPECT_THAT(clean.out, HasSubstr("outliers: none of 1696 values beyond"));
  EXPECT_THAT(clean.out, Not(HasSubstr("worst:")));
  EXPECT_THAT(fit({brass, "-m", "ward-aniso"}).out, Not(HasSubstr("outliers")));
}

TEST(FitCommand, ResidualsMarkTheOutliersAndLeaveEmptyWhatWasNotUsed) {
  const TemporaryFolder folder;
  auto [table, corrupted] = brass_with_outliers();
  table.channels = {"R", "G"};
  table.values.push_back(table.values[0]);
  table.sigma.clear();
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (corrupted.contains(i)) table.values[1][i] /= 20;  // G is clean
    if (i % 10 == 3) table.values[1][i] = NAN;            // and has holes
  }
  const std::string path = write_table(folder, "holes.csv", table);
  const std::string residuals = folder / "residuals.csv";
  const json material = json_of({path, "-m", "ward-aniso", "--metric", "relative", "--loss",
                                 "tukey", "--max-theta", "60", "--residuals", residuals});
  const std::vector<double> red = column_of(content_of(residuals), "R_outlier");
  const std::vector<double> green = column_of(content_of(residuals), "G_outlier");
  ASSERT_EQ(red.size(), table.size());
  ASSERT_EQ(green.size(), table.size());
  const double cos_60 = 0.5 - 1e-9;
  std::size_t ones = 0;
  std::size_t unused = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool used = table.wi.z[i] >= cos_60 && table.wo.z[i] >= cos_60;
    if (!used) ++unused;
    EXPECT_EQ(std::isnan(red[i]), !used) << i;
    EXPECT_EQ(std::isnan(green[i]), !used || i % 10 == 3) << i;
    if (!used) continue;
    EXPECT_EQ(red[i], corrupted.contains(i) ? 1 : 0) << i;
    if (i % 10 != 3) {
      EXPECT_EQ(green[i], 0) << i;
    }
    if (corrupted.contains(i)) ++ones;
  }
  EXPECT_GT(unused, 100U);
  EXPECT_EQ(material.at("fit").at("outliers").at("count"), ones);
}

TEST(FitCommand, ResidualsMarkMoreOutliersThanTheResultLists) {
  const TemporaryFolder folder;
  const std::string residuals = folder / "residuals.csv";
  // An isotropic lobe misses the brushed one by far more than this scale nearly everywhere.
  const json outliers = json_of({brass, "-m", "ward", "--loss", "tukey", "--loss-scale", "0.01",
                                 "--residuals", residuals})
                            .at("fit")
                            .at("outliers");
  const std::vector<double> marks = column_of(content_of(residuals), "Y_outlier");
  EXPECT_EQ(outliers.at("listed").size(), 1000U);
  EXPECT_GT(outliers.at("count").get<std::size_t>(), 1000U);
  EXPECT_EQ(std::count(marks.begin(), marks.end(), 1.0),
            outliers.at("count").get<std::ptrdiff_t>());
}

TEST(FitCommand, ResidualsRefuseAChannelThatIsNamedLikeTheOutliersOnlyWithALoss) {
  const TemporaryFolder folder;
  table::SampleTable table = instrument::synthesize(brass_recipe());
  table.channels = {"Y", "Y_outlier"};
  table.values.push_back(table.values[0]);
  const std::string path = write_table(folder, "table.csv", table);
  const std::vector<std::string> plain{path, "-m", "ward", "--residuals", folder / "residuals.csv"};
  EXPECT_EQ(fit(plain).exit_status, 0);
  std::vector<std::string> robust = plain;
  robust.insert(robust.end(), {"--loss", "huber"});
  const CommandResult refused = fit(robust);
  EXPECT_EQ(refused.exit_status, 2);
  EXPECT_THAT(refused.err, HasSubstr("'Y_outlier'"));
}

}  // namespace
}  // namespace gonio::tests
