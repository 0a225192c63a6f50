// The recommended table of fitted materials beside the fit's residual: the short form of
// bench/table_residuals.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "bench/table_residuals_study.h"
#include "tests/real_data.h"

namespace gonio::bench {
namespace {

void expect_figure(const TableResidual& result) {
  SCOPED_TRACE(result.name);
  ASSERT_TRUE(result.check);
  EXPECT_TRUE(figure_holds(result));
  EXPECT_LT(result.share(), 0.01);  // the figure
  EXPECT_GT(result.share(), 1e-4) << "a table that errs by nothing was not the smallest";
  EXPECT_LE(trade::worst_error(*result.check).largest, trade::half_display_step);
}

TEST(TableResiduals, OfWardsMaterialsAreUnderOnePercent) {
  const auto materials = ward_materials(GONIO_SOURCE_DIR);
  ASSERT_EQ(materials.size(), 10U);  // Ward 1992, Table 1
  for (const char* name : {"enamel_finished_metal", "white_ceramic_tile"}) {
    const auto found = std::find_if(materials.begin(), materials.end(), [&](const auto& m) {
      return std::filesystem::path(m.path).stem() == name;
    });
    ASSERT_NE(found, materials.end());
    expect_figure(table_residual(*found, nullptr));
  }
}

TEST(TableResiduals, OfAPaintAreUnderOnePercent) {
  GONIO_REAL_DATA_OR_SKIP(path, "paints/C8_Silver.astm");
  const std::string data = std::filesystem::path(path).parent_path().parent_path().string();
  const auto materials = paints(data);
  ASSERT_EQ(materials.size(), 5U);
  const auto silver = std::find_if(materials.begin(), materials.end(),
                                   [&](const auto& m) { return m.path == path; });
  ASSERT_NE(silver, materials.end());
  expect_figure(table_residual(*silver, nullptr));
}

TEST(TableResiduals, AreThereOnlyWherePaintsAre) { EXPECT_TRUE(paints("/nowhere").empty()); }

}  // namespace
}  // namespace gonio::bench
