// A CSV that does not say what it holds, and the options that say it.
#include "table/formats/foreign_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "table/file_error.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using table::AngleUnit;
using table::Quantity;
using table::ReadOptions;
using table::SampleTable;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

ReadOptions said(const std::string& columns, std::optional<Quantity> quantity = Quantity::brdf,
                 std::optional<AngleUnit> angles = AngleUnit::degrees) {
  ReadOptions options;
  options.columns = columns;
  options.quantity = quantity;
  options.angles = angles;
  return options;
}

SampleTable read_text(const std::string& content, const ReadOptions& options) {
  const TemporaryFolder folder;
  return table::read(folder.write("foreign.csv", content), options);
}

std::string refusal(const std::string& content, const ReadOptions& options) {
  try {
    read_text(content, options);
  } catch (const table::FileError& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "accepted";
}

constexpr const char* four_and_two = "theta_i,phi_i,theta_o,phi_o,R,G";

TEST(ForeignCsv, ReadsEverySeparatorTheSame) {
  const std::string titles = "scatterometer 7\n\n";
  for (const std::string& row :
       {std::string("20,180,30,0,1.5,0.5\n"), std::string("20;180;30;0;1.5;0.5\n"),
        std::string("20\t180\t30\t0\t1.5\t0.5\n"), std::string(" 20  180 30 0  1.5 0.5 \r\n")}) {
    const SampleTable table = read_text(titles + row + row, said(four_and_two));
    ASSERT_EQ(table.size(), 2U) << row;
    EXPECT_THAT(table.channels, ElementsAre("R", "G"));
    EXPECT_EQ(table.values[0][1], 1.5);
    EXPECT_EQ(table.values[1][0], 0.5);
    EXPECT_NEAR(table.wi.z[0], std::cos(20 * std::numbers::pi / 180), 1e-15);
    EXPECT_NEAR(table.wi.x[0], -std::sin(20 * std::numbers::pi / 180), 1e-15);
  }
}

TEST(ForeignCsv, ConvertsWhatTheOptionsSayThatTheNumbersAre) {
  const std::string row = "0.5,0,0.25,0,2,1\n";
  const SampleTable cosine =
      read_text(row, said(four_and_two, Quantity::brdf_cos, AngleUnit::radians));
  EXPECT_NEAR(cosine.values[0][0], 2 / std::cos(0.5), 1e-15);
  const SampleTable factor =
      read_text(row, said(four_and_two, Quantity::reflectance_factor, AngleUnit::radians));
  EXPECT_NEAR(factor.values[0][0], 2 / std::numbers::pi, 1e-15);
  EXPECT_EQ(factor.provenance.quantity, Quantity::reflectance_factor);
}

TEST(ForeignCsv, TakesNamesAndUnitFromTheHeader) {
  ReadOptions options;
  options.quantity = Quantity::brdf;
  const SampleTable table = read_text(
      "Theta_in (deg);phi_in (deg);theta_s_deg;phi_s_deg;550nm\n20;180;30;0;1.5\n", options);
  EXPECT_THAT(table.channels, ElementsAre("550nm"));
  EXPECT_EQ(table.provenance.angles, AngleUnit::degrees);
  EXPECT_EQ(table.values[0][0], 1.5);
}

TEST(ForeignCsv, PassesColumnsOverWhateverTheyHold) {
  const SampleTable table = read_text("id,a,b,c,d,remark,R\nfirst,20,180,30,0,very good,1.5\n",
                                      said("-,theta_i,phi_i,theta_o,phi_o,-,R"));
  ASSERT_EQ(table.size(), 1U);
  EXPECT_THAT(table.channels, ElementsAre("R"));
  EXPECT_EQ(table.values[0][0], 1.5);
}

TEST(ForeignCsv, TakesAnAngleThatNoColumnHoldsAsAConstant) {
  const SampleTable table =
      read_text("20 30 40 1.5\n20 30 50 0.5\n", said("theta_i,theta_o,phi_o,R,phi_i=180"));
  ASSERT_EQ(table.size(), 2U);
  EXPECT_NEAR(table.wi.x[1], -std::sin(20 * std::numbers::pi / 180), 1e-15);
  EXPECT_NEAR(table.wo.y[0],
              std::sin(30 * std::numbers::pi / 180) * std::sin(40 * std::numbers::pi / 180), 1e-15);
}

TEST(ForeignCsv, ReadsAScanInThePlaneOfIncidence) {
  const SampleTable table = read_text("incidence,exit,R\n10,20,0.1\n20,20,0.2\n",
                                      said("theta_i,theta_o,R,phi_i=0,phi_o=180"));
  ASSERT_EQ(table.size(), 2U);
  EXPECT_EQ(table.values[0][1], 0.2);
  EXPECT_NEAR(table.wo.x[0], -std::sin(20 * std::numbers::pi / 180), 1e-15);
  EXPECT_THAT(refusal("incidence,exit,R\n10,20,0.1\n", {}), HasSubstr("--columns"));
}

TEST(ForeignCsv, RefusesAWavelengthTwice) {
  EXPECT_THAT(refusal("20,180,30,0,1,2\n", said("theta_i,phi_i,theta_o,phi_o,550nm,550.0 nm")),
              HasSubstr("of one wavelength"));
}

TEST(ForeignCsv, KeepsSigmaWeightAndHoles) {
  const SampleTable table = read_text("20,180,30,0,1.5,0.1,2\n20,180,40,0,,,\n",
                                      said("theta_i,phi_i,theta_o,phi_o,R,sigma_R,weight"));
  EXPECT_EQ(table.sigma[0][0], 0.1);
  EXPECT_EQ(table.weight[0], 2);
  EXPECT_EQ(table.mask[1], table::MaskReason::hole);
}

TEST(ForeignCsv, NamesTheLineAndTheOptionsThatAreMissing) {
  const std::string rows = "20,180,30,0,1.5,0.5\n";
  EXPECT_THAT(refusal(rows, {}),
              AllOf(HasSubstr("without the line '# gonio-table 1'"), HasSubstr("--quantity"),
                    HasSubstr("--angles"), HasSubstr("--columns")));
  EXPECT_THAT(refusal(rows, said(four_and_two, std::nullopt)),
              AllOf(HasSubstr("'# quantity: brdf'"), HasSubstr("--quantity")));
  EXPECT_THAT(refusal(rows, said(four_and_two, Quantity::brdf, std::nullopt)),
              AllOf(HasSubstr("'# angles: deg'"), HasSubstr("--angles")));
  EXPECT_THAT(refusal(rows, said("")), HasSubstr("--columns theta_i"));
  EXPECT_THAT(refusal("incidence,azimuth,exit,azimuth,R,G\n" + rows, said("")),
              AllOf(HasSubstr("names no column theta_i"), HasSubstr("--columns")));
}

TEST(ForeignCsv, RefusesWhatContradictsItself) {
  const std::string rows = "20,180,30,0,1.5,0.5\n";
  EXPECT_THAT(refusal(rows, said("theta_i,phi_i,theta_o,phi_o,R")),
              AllOf(HasSubstr(":1: found 6 columns, expected 5"), HasSubstr("--columns")));
  EXPECT_THAT(refusal(rows, said("theta_i,theta_i,theta_o,phi_o,R,G,phi_i=0")),
              HasSubstr("both named 'theta_i'"));
  EXPECT_THAT(refusal("20;180;30;0;1,5;0,5\n", said(four_and_two)), HasSubstr("decimal point"));
  EXPECT_THAT(refusal("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_rad,R\n20,180,30,0,1\n", said("")),
              HasSubstr("another unit"));
  EXPECT_THAT(refusal("theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R\n20,180,30,0,1\n",
                      said("", Quantity::brdf, AngleUnit::radians)),
              AllOf(HasSubstr("say that angles are in deg"), HasSubstr("--angles says rad")));
  EXPECT_THAT(refusal("20 30 40 1.5\n", said("theta_i,theta_o,phi_o,R,phi_i=x")),
              HasSubstr("ANGLE=NUMBER"));
  EXPECT_THAT(refusal("20 30 40 1.5\n", said("theta_i,phi_i,phi_o,R,theta_o=95")),
              HasSubstr("theta_o=95"));
  EXPECT_THAT(refusal(rows + "95,180,30,0,1.5,0.5\n", said(four_and_two)),
              HasSubstr(":2: column 'theta_i': found '95'"));
}

TEST(ForeignCsv, OptionsAreRefusedForAFileThatSaysItself) {
  EXPECT_THAT(refusal("# gonio-table 1\n# quantity: brdf\n# angles: deg\n"
                      "theta_i,phi_i,theta_o,phi_o,R\n20,0,20,0,1\n",
                      said(four_and_two)),
              HasSubstr("says itself what it holds: leave out --columns"));
  ReadOptions material;
  material.material = 3;
  EXPECT_THAT(refusal("# gonio-table 1\n# quantity: brdf\n# angles: deg\n"
                      "theta_i,phi_i,theta_o,phi_o,R\n20,0,20,0,1\n",
                      material),
              HasSubstr("leave out --material"));
}

TEST(Directions, AreReadFromAnyCsvThatNamesThem) {
  const TemporaryFolder folder;
  const std::string gonio = folder.write(
      "gonio.csv", "# gonio-table 1\n# angles: deg\ntheta_o,phi_o,theta_i,phi_i\n30,0,20.0,180\n");
  const std::string foreign = folder.write(
      "foreign.csv", "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R,G\n20.0,180,30,0,x,\n");
  for (const std::string& path : {gonio, foreign}) {
    const SampleTable directions = table::read_directions(path, {});
    ASSERT_EQ(directions.size(), 1U) << path;
    EXPECT_TRUE(directions.channels.empty());
    EXPECT_THAT(directions.angle_text, ElementsAre("20.0,180,30,0"));
    EXPECT_NEAR(directions.wo.z[0], std::cos(30 * std::numbers::pi / 180), 1e-15);
  }
}

}  // namespace
}  // namespace gonio::tests
