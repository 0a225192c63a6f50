// Writing a gonio-table: reading it back gives the same table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "table/file_error.h"
#include "table/formats/gonio_csv.h"
#include "tests/gonio_csv_text.h"

namespace gonio::tests {
namespace {

using table::MaskReason;
using table::SampleTable;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

SampleTable parse(const std::string& text) { return table::read_gonio_csv(text, "t.csv", {}); }

SampleTable random_table(std::size_t size) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> cosine(0.01, 1), phi(-pi, pi), value(-1e-3, 5);
  SampleTable table;
  table.name = "a\nname, \"quoted\"";
  table.channels = {"R", "550nm"};
  table.wi.resize(size);
  table.wo.resize(size);
  table.values.assign(2, std::vector<double>(size));
  table.sigma.assign(2, std::vector<double>(size));
  table.weight.resize(size);
  table.mask.assign(size, MaskReason::none);
  for (std::size_t i = 0; i < size; ++i) {
    // The pole, where azimuth means nothing, and the seam at 180 deg are among them.
    const double theta = i % 10 == 0 ? 0 : std::acos(cosine(random));
    table.wi.set(i, brdf::direction_from_radians(theta, i % 7 == 0 ? pi : phi(random)));
    table.wo.set(i, brdf::direction_from_radians(std::acos(cosine(random)), phi(random)));
    for (std::size_t c = 0; c < 2; ++c) {
      table.values[c][i] = value(random);
      table.sigma[c][i] = std::abs(value(random)) + 1e-300;
    }
    table.weight[i] = std::abs(value(random));
  }
  return table;
}

TEST(GonioCsv, WritesWhatReadsBackToTheSameTable) {
  const SampleTable table = random_table(5000);
  const SampleTable back = parse(written(table));
  EXPECT_EQ(back.name, "a name, \"quoted\"");
  EXPECT_EQ(back.channels, table.channels);
  EXPECT_EQ(back.values, table.values);
  EXPECT_EQ(back.sigma, table.sigma);
  EXPECT_EQ(back.weight, table.weight);
  EXPECT_EQ(back.mask, table.mask);
  for (std::size_t i = 0; i < table.size(); ++i) {
    // Degrees of 180 have a spacing of 2.8e-14, which is 5e-16 in radians.
    EXPECT_NEAR(back.wi.x[i], table.wi.x[i], 1e-15);
    EXPECT_NEAR(back.wi.y[i], table.wi.y[i], 1e-15);
    EXPECT_NEAR(back.wi.z[i], table.wi.z[i], 1e-15);
    EXPECT_NEAR(back.wo.x[i], table.wo.x[i], 1e-15);
    EXPECT_NEAR(back.wo.y[i], table.wo.y[i], 1e-15);
    EXPECT_NEAR(back.wo.z[i], table.wo.z[i], 1e-15);
  }
}

TEST(GonioCsv, WritesHolesAndWhatNobodyMeasuredAsEmptyFields) {
  SampleTable table = random_table(3);
  table.values[0][0] = std::numeric_limits<double>::quiet_NaN();
  table.sigma[0][0] = std::numeric_limits<double>::quiet_NaN();
  table.mask[1] = MaskReason::extrapolated;
  const SampleTable back = parse(written(table));
  EXPECT_TRUE(std::isnan(back.values[0][0]));
  EXPECT_EQ(back.values[1][0], table.values[1][0]);
  EXPECT_THAT(back.mask, ElementsAre(MaskReason::none, MaskReason::hole, MaskReason::none));
}

TEST(GonioCsv, WritesExtraColumnsBehindTheChannels) {
  SampleTable table = random_table(3);
  table.sigma.clear();
  table.mask[1] = MaskReason::extrapolated;
  const std::vector<double> model{.5, .25, std::numeric_limits<double>::quiet_NaN()};
  const std::string text = written(table, {{"R_model", model}});
  EXPECT_THAT(text, HasSubstr("\ntheta_i,phi_i,theta_o,phi_o,R,550nm,R_model,weight\n"));
  const SampleTable back = parse(text);
  EXPECT_THAT(back.channels, ElementsAre("R", "550nm", "R_model"));
  EXPECT_EQ(back.values[2][0], .5);
  EXPECT_EQ(back.values[2][1], .25) << "a model has a value where nobody measured, too";
  EXPECT_TRUE(std::isnan(back.values[2][2]));
}

TEST(GonioCsv, RefusesToWriteChannelNamesThatItCannotHold) {
  for (const std::string name : {"a,b", "a\nb", "a\"b", " a", "", "weight", "theta_i", "sigma_R"}) {
    SampleTable table = random_table(1);
    table.channels[1] = name;
    EXPECT_THROW(written(table), table::FileError) << name;
  }
}

}  // namespace
}  // namespace gonio::tests
