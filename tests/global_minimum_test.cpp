// No start value is needed: the fit ends at the global minimum, which a dense scan confirms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "fit/fit.h"
#include "table/read.h"
#include "tests/real_data.h"
#include "tests/ward_scan.h"

namespace gonio::tests {
namespace {

bool has_numpy() { return std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") == 0; }

TEST(TheGlobalMinimum, IsFoundForAHundredTruthsWithoutAStartValue) {
  const std::string script = peer_script("ward_table.py");
  if (script.empty()) {
    GTEST_SKIP() << "ward_table.py not found: set GONIO_PEERS to the folder that holds it";
  }
  if (!has_numpy()) GTEST_SKIP() << "ward_table.py needs python3-numpy";
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("gonio_minimum_{}", ::getpid());
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "table.csv").string();

  std::mt19937_64 random(2024);
  const auto draw = [&] {  // log-uniform in 0.02 .. 0.8
    const double u = double(random() >> 11) * 0x1p-53;
    return 0.02 * std::pow(0.8 / 0.02, u);
  };
  int found = 0;
  double worst_ratio = 0;
  for (int truth = 0; truth < 100; ++truth) {
    const double alpha_x = draw();
    const double alpha_y = draw();
    const std::string command =
        fmt::format("/usr/bin/python3 '{}' 10000 '{}' --seed {} --ax {} --ay {}", script, path,
                    truth + 1, alpha_x, alpha_y);
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    const table::SampleTable table = table::read(path);
    const fit::FitResult result =
        fit::fit(brdf::Model("ward-aniso"), table, {.metric = fit::Metric::l2});
    const WardScan scan(table, 80);
    const double scanned = scan.least_cost_over_both_roughnesses(&WardScan::ward);
    EXPECT_LE(result.cost, scanned * (1 + 1e-9)) << "truth " << alpha_x << ", " << alpha_y;
    EXPECT_TRUE(result.converged) << "truth " << alpha_x << ", " << alpha_y;
    found += result.cost <= scanned * (1 + 1e-9) ? 1 : 0;
    worst_ratio = std::max(worst_ratio, result.cost / scanned);
  }
  std::filesystem::remove_all(folder);
  std::printf("global minimum found for %d of 100 truths; largest cost / scan's best: %.9f\n",
              found, worst_ratio);
}

class EveryPaint : public testing::TestWithParam<const char*> {};

TEST_P(EveryPaint, IsFittedNoWorseThanByADenseScan) {
  GONIO_REAL_DATA_OR_SKIP(path, fmt::format("paints/{}.astm", GetParam()));
  const table::SampleTable table = table::read(path);
  for (const auto& [name, lobe] :
       {std::pair{"ward-gmd", &WardScan::ward_gmd}, std::pair{"ward-duer", &WardScan::ward_duer}}) {
    const fit::FitResult result = fit::fit(brdf::Model(name), table, {.metric = fit::Metric::l2});
    EXPECT_TRUE(result.converged) << name;
    const WardScan scan(table, 80);
    const double scanned = scan.least_cost_over_one_roughness(lobe);
    EXPECT_LE(result.cost, scanned * (1 + 1e-6)) << name;  // the figure
    std::printf("%-20s %-10s alpha %.5f  cost / scan's best - 1: %+.1e\n", GetParam(), name,
                result.values.shape[0], result.cost / scanned - 1);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Paints, EveryPaint,
    testing::Values("C10_Copper", "C12_OliveDrab", "C14_NavyBlue", "C16_StrongGreen", "C18_rlm70_1",
                    "C1_White", "C21_MiddleStone", "C23_DarkGreen2", "C26_DarkEggGreenGray",
                    "C28_BlackishIronBlue", "C2_Black", "C32_WarshipColor2", "C35_BrightGray",
                    "C37_RLM75", "C39_DarkYellow", "C4_Yellow", "C6_Green", "C8_Silver",
                    "Char_Pink", "Metal_Blue", "Metal_Purpule", "Metal_Yellow"),
    [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace gonio::tests
