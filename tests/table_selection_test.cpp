// Parts of tables and tables put together: channels, samples, masks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "brdf/direction.h"
#include "table/channel_choice.h"
#include "table/coverage_map.h"
#include "table/describe.h"
#include "table/file_error.h"
#include "table/masks.h"
#include "table/selection.h"

namespace gonio::tests {
namespace {

using brdf::direction_from_degrees;
using table::MaskReason;
using table::SampleTable;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Viewers every 10 deg in the plane of incidence, lit at 30 deg from azimuth 180. Channel c of
/// sample i is 10 c + i.
SampleTable scan(const std::vector<std::string>& channels) {
  SampleTable table;
  table.channels = channels;
  table.values.resize(channels.size());
  for (int i = 0; i < 9; ++i) {
    table.wi.push_back(direction_from_degrees(30, 180));
    table.wo.push_back(direction_from_degrees(10.0 * i, 180));
    table.mask.push_back(MaskReason::none);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      table.values[c].push_back(10 * static_cast<double>(c) + i);
    }
  }
  return table;
}

std::string choice_refusal(const std::vector<std::string>& channels, const std::string& choice) {
  try {
    table::chosen_channels(channels, choice);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ChannelChoice, KnowsNamesRangesAndWavelengths) {
  const std::vector<std::string> spectral{"400nm", "450nm", "500nm", "550nm", "600nm"};
  EXPECT_THAT(table::chosen_channels(spectral, "550nm"), ElementsAre(3U));
  EXPECT_THAT(table::chosen_channels(spectral, "550.2nm"), ElementsAre(3U));
  EXPECT_THAT(table::chosen_channels(spectral, "440nm..510nm"), ElementsAre(1U, 2U));
  EXPECT_THAT(table::chosen_channels(spectral, "450nm..550nm"), ElementsAre(1U, 2U, 3U));
  EXPECT_THAT(table::chosen_channels(spectral, "600nm, 400nm,600nm"), ElementsAre(4U, 0U));
  const std::vector<std::string> rgb{"R", "G", "B"};
  EXPECT_THAT(table::chosen_channels(rgb, "B,R"), ElementsAre(2U, 0U));
  EXPECT_THAT(table::chosen_channels(rgb, "G..B"), ElementsAre(1U, 2U));
}

TEST(ChannelChoice, NamesWhatThereIs) {
  const std::vector<std::string> rgb{"R", "G", "B"};
  EXPECT_THAT(choice_refusal(rgb, "R,Y"),
              AllOf(HasSubstr("channels Y: the table has none such, but R, G, B")));
  EXPECT_THAT(choice_refusal(rgb, "611nm"), HasSubstr("the table has none such"));
  EXPECT_THAT(choice_refusal(rgb, "B..R"), HasSubstr("the table has none such"));
  EXPECT_THAT(choice_refusal(rgb, ""), HasSubstr("the table has none such"));
}

TEST(ChannelChoice, ASampleWithoutAMeasuredChannelBecomesAHole) {
  SampleTable table = scan({"R", "G"});
  table.values[1][4] = std::numeric_limits<double>::quiet_NaN();
  keep_channels(table, std::vector<std::size_t>{1});
  EXPECT_THAT(table.channels, ElementsAre("G"));
  EXPECT_EQ(table.values[0][3], 13);
  EXPECT_EQ(table.mask[4], MaskReason::hole);
  EXPECT_EQ(table.mask[3], MaskReason::none);
}

TEST(Masks, RetroReflectionIsMaskedByTheAngleToTheLight) {
  SampleTable table = scan({"R"});
  // 20, 30 and 40 deg are within 10.5 deg of the light at 30 deg; 30 alone within 9.5.
  EXPECT_EQ(table::mask_retro(table, 9.5), 1U);
  EXPECT_EQ(table.mask[3], MaskReason::retro);
  EXPECT_EQ(table::mask_retro(table, 10.5), 2U);
  EXPECT_EQ(table.mask[2], MaskReason::retro);
  EXPECT_EQ(table.mask[5], MaskReason::none);
}

TEST(Masks, ABlindSpotIsMaskedAndEarlierReasonsStay) {
  SampleTable table = scan({"R"});
  table.mask[7] = MaskReason::hole;
  EXPECT_EQ(table::mask_blind_spot(table, direction_from_degrees(70, 180), 10.5), 2U);
  EXPECT_EQ(table.mask[6], MaskReason::blind_spot);
  EXPECT_EQ(table.mask[7], MaskReason::hole);
  EXPECT_EQ(table.mask[8], MaskReason::blind_spot);
}

TEST(Masks, EveryReasonHasANameThatFindsIt) {
  for (std::size_t i = 0; i < table::mask_reason_count; ++i) {
    const auto reason = static_cast<MaskReason>(i);
    ASSERT_FALSE(name(reason).empty());
    EXPECT_EQ(table::mask_reason_named(name(reason)), reason);
  }
  EXPECT_FALSE(table::mask_reason_named("moon"));
}

TEST(Selection, CropsBothAnglesInclusively) {
  SampleTable table = scan({"R"});
  table::crop(table, 50);
  EXPECT_EQ(table.size(), 6U);
  EXPECT_THAT(table.values[0], ElementsAre(0, 1, 2, 3, 4, 5));
  table::crop(table, 29);  // the light is at 30
  EXPECT_EQ(table.size(), 0U);
}

TEST(Selection, KeepsEveryArrayInStep) {
  SampleTable table = scan({"R", "G"});
  table.sigma = {std::vector<double>(9, 0.5), std::vector<double>(9, 0.25)};
  table.weight.resize(9);
  std::iota(table.weight.begin(), table.weight.end(), 100);
  table.angle_text.resize(9, "text");
  keep_samples(table, [](std::size_t i) { return i % 4 == 1; });
  EXPECT_THAT(table.values[1], ElementsAre(11, 15));
  EXPECT_THAT(table.weight, ElementsAre(101, 105));
  EXPECT_EQ(table.sigma[1].size(), 2U);
  EXPECT_EQ(table.angle_text.size(), 2U);
  EXPECT_EQ(table.wo.x[1], direction_from_degrees(50, 180).x);
  EXPECT_EQ(table.mask.size(), 2U);
}

TEST(Selection, MergesTablesWithTheirChannelsInAnyOrder) {
  std::vector<SampleTable> tables{scan({"R", "G"}), scan({"G", "R"})};
  tables[1].name = "second";
  const SampleTable merged = table::merge(tables);
  EXPECT_EQ(merged.size(), 18U);
  EXPECT_THAT(merged.channels, ElementsAre("R", "G"));
  EXPECT_EQ(merged.values[0][1], 1);
  EXPECT_EQ(merged.values[0][10], 11);  // R is the second table's channel 1
  EXPECT_EQ(merged.values[1][10], 1);
  EXPECT_EQ(merged.name, "second");
}

TEST(Selection, RefusesToMergeWhatDiffers) {
  const auto refusal = [](SampleTable a, SampleTable b) -> std::string {
    a.provenance.path = "a.csv";
    b.provenance.path = "b.csv";
    std::vector<SampleTable> tables{std::move(a), std::move(b)};
    try {
      table::merge(tables);
    } catch (const table::FileError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refusal(scan({"R", "G"}), scan({"R"})),
              AllOf(HasSubstr("b.csv: found the channels R, expected R, G"), HasSubstr("a.csv")));
  SampleTable weighted = scan({"R"});
  weighted.weight.assign(9, 1);
  EXPECT_THAT(refusal(scan({"R"}), weighted),
              HasSubstr("b.csv: found weight, which a.csv has not"));
  SampleTable with_sigma = scan({"R"});
  with_sigma.sigma = {std::vector<double>(9, 1)};
  EXPECT_THAT(refusal(with_sigma, scan({"R"})), HasSubstr("a.csv: found sigma, which b.csv"));
}

TEST(CoverageMap, ShowsSamplesAndWhyOthersAreMasked) {
  SampleTable table = scan({"R"});
  table::mask_retro(table, 5);               // 30 deg
  table.mask[8] = MaskReason::extrapolated;  // 80 deg
  const auto description = table::describe(table);
  const auto maps = table::coverage_maps(table, description, 4);
  ASSERT_EQ(maps.size(), 1U);
  EXPECT_NEAR(maps[0].theta_i_deg, 30, 1e-9);
  const auto& cells = maps[0].cells;
  EXPECT_EQ(cells[0][0], MaskReason::none);
  EXPECT_EQ(cells[0][12], MaskReason::none);  // the pole is at every azimuth
  EXPECT_EQ(cells[3][0], MaskReason::retro);
  EXPECT_EQ(cells[3][1], std::nullopt);
  EXPECT_EQ(cells[7][0], MaskReason::none);
  EXPECT_EQ(cells[8][0], MaskReason::extrapolated);
  EXPECT_EQ(cells[8][12], std::nullopt);  // nothing on the mirror's side
}

}  // namespace
}  // namespace gonio::tests
