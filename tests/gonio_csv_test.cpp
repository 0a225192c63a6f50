// Reading the project's own table: what is read as what, whatever the locale and the threads.
#include "table/formats/gonio_csv.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <locale>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "table/file_error.h"
#include "table/read.h"
#include "tests/gonio_csv_text.h"

namespace gonio::tests {
namespace {

using table::AngleUnit;
using table::MaskReason;
using table::Quantity;
using table::SampleTable;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

SampleTable parse(const std::string& content, const table::ReadOptions& options = {}) {
  return table::read_gonio_csv(content, "t.csv", options);
}

std::vector<std::uint64_t> bits(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> result;
  for (const double x : numbers) result.push_back(std::bit_cast<std::uint64_t>(x));
  return result;
}

/// A table of many blocks, with every kind of number that %.17g prints.
std::string big_table(std::size_t rows) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> theta(0, 89), phi(-180, 180), value(-1e-3, 30);
  std::string text = header("brdf_cos", "deg", "theta_i,phi_i,theta_o,phi_o,R,sigma_R,weight");
  for (std::size_t i = 0; i < rows; ++i) {
    text +=
        fmt::format("{},{:.6f},{:.12g},{},{},{:e},{}\n", theta(random), phi(random), theta(random),
                    phi(random), value(random), std::abs(value(random)) + 1e-9, i % 7);
    if (i % 1000 == 0) text += "# a comment\n\n";
  }
  return text;
}

TEST(GonioCsv, ReadsDirectionsAndValues) {
  const SampleTable table = parse(
      "# gonio-table 1\n# quantity: brdf\n# angles: deg\n"
      "# name: rolled brass \n# operator: me\n"
      "theta_i,phi_i,theta_o,phi_o,R,550nm\n"
      "30,90,60,180,0.25,-1e-3\n");
  ASSERT_EQ(table.size(), 1u);
  EXPECT_EQ(table.name, "rolled brass");
  EXPECT_THAT(table.channels, ElementsAre("R", "550nm"));
  // sin and cos of 30 and 60 deg are 1/2 and sqrt(3)/2; azimuths along y and -x.
  const double root = std::sqrt(3) / 2;
  EXPECT_NEAR(table.wi.x[0], 0, 1e-16);
  EXPECT_NEAR(table.wi.y[0], .5, 1e-16);
  EXPECT_NEAR(table.wi.z[0], root, 1e-15);
  EXPECT_NEAR(table.wo.x[0], -root, 1e-15);
  EXPECT_NEAR(table.wo.y[0], 0, 2e-16);
  EXPECT_NEAR(table.wo.z[0], .5, 2e-16);
  EXPECT_EQ(table.values[0][0], .25);
  EXPECT_EQ(table.values[1][0], -1e-3) << "a small negative reading is data";
  EXPECT_EQ(table.mask[0], MaskReason::none);
  EXPECT_FALSE(table.has_sigma());
  EXPECT_FALSE(table.has_weight());
  EXPECT_EQ(table.provenance.format, "gonio-table 1");
  EXPECT_EQ(table.provenance.path, "t.csv");
}

TEST(GonioCsv, TurnsEveryQuantityAndUnitIntoBrdf) {
  const std::string columns = "theta_i,phi_i,theta_o,phi_o,R,sigma_R";
  const SampleTable cosine = parse(header("brdf_cos", "deg", columns) + "60,0,0,0,2,0.5\n");
  // cos(60 deg) = 1/2; the angle in radians is rounded, hence the tolerance.
  EXPECT_NEAR(cosine.values[0][0], 4, 1e-14);
  EXPECT_NEAR(cosine.sigma[0][0], 1, 1e-15);
  EXPECT_EQ(cosine.provenance.quantity, Quantity::brdf_cos);
  const SampleTable factor =
      parse(header("reflectance_factor", "rad", columns) + "0.5,1,0.25,-1,1,0.5\n");
  EXPECT_EQ(factor.values[0][0], 1 / pi);
  EXPECT_EQ(factor.sigma[0][0], 0.5 / pi);
  EXPECT_EQ(factor.wi.z[0], std::cos(.5));
  EXPECT_EQ(factor.wo.y[0], std::sin(.25) * std::sin(-1.0));
  EXPECT_EQ(factor.provenance.angles, AngleUnit::radians);
}

TEST(GonioCsv, TakesColumnsInAnyOrder) {
  const SampleTable table =
      parse(header("brdf", "deg", "weight,sigma_G,G,phi_o,theta_o,sigma_R,phi_i,R,theta_i") +
            "2,.1,7,90,40,.2,180,8,20\n");
  EXPECT_THAT(table.channels, ElementsAre("G", "R"));
  EXPECT_THAT(table.values, ElementsAre(ElementsAre(7), ElementsAre(8)));
  EXPECT_THAT(table.sigma, ElementsAre(ElementsAre(.1), ElementsAre(.2)));
  EXPECT_THAT(table.weight, ElementsAre(2));
  EXPECT_NEAR(table.wi.x[0], -std::sin(20 * pi / 180), 1e-15);
  EXPECT_NEAR(table.wo.y[0], std::sin(40 * pi / 180), 1e-15);
}

TEST(GonioCsv, AcceptsWhatDoesNoHarm) {
  const SampleTable expected = parse(plain + "10,20,30,40,1.5,2\n11,21,31,41,3,4\n");
  const std::vector<std::string> variants{
      "\xEF\xBB\xBF# gonio-table 1\r\n# quantity: brdf\r\n# angles: deg\r\n\r\n"
      "theta_i,phi_i,theta_o,phi_o,R,G\r\n10,20,30,40,1.5,2\r\n\r\n11,21,31,41,3,4\r\n",
      "\n \n#gonio-table 1\n# quantity: brdf   (brdf | brdf_cos | reflectance_factor)\n"
      "# angles: deg            (deg | rad)\n\ntheta_i, phi_i , theta_o,phi_o,R,G,\n"
      "10,20,30,40,1.5,2,\n# between rows\n\n  # indented\n11,21,31,41,3,4,\n\n\n",
      plain + " +10 ,\t2e1, 30.0 ,40.,+1.5E0,0.2e+1\n11,21,31,41,3,4"};
  for (const std::string& variant : variants) {
    const SampleTable table = parse(variant);
    EXPECT_EQ(table.channels, expected.channels) << variant;
    EXPECT_EQ(table.values, expected.values) << variant;
    EXPECT_EQ(table.wi.x, expected.wi.x) << variant;
    EXPECT_EQ(table.wo.y, expected.wo.y) << variant;
    EXPECT_EQ(table.wo.z, expected.wo.z) << variant;
  }
}

/// Decimal commas, as a German or French locale has them.
struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(GonioCsv, DoesNotCareForTheLocale) {
  const std::string text = plain + "10.5,20.25,30.125,40,12345.678,0.001\n";
  const SampleTable expected = parse(text);
  const std::string expected_text = written(expected);
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) {  // where they are installed
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  }
  const SampleTable table = parse(text);
  const std::string table_text = written(table);
  std::setlocale(LC_ALL, "C");
  std::locale::global(before);
  EXPECT_EQ(table.values, expected.values);
  EXPECT_EQ(table.wi.x, expected.wi.x);
  EXPECT_EQ(table_text, expected_text);
  EXPECT_THAT(table_text, HasSubstr("12345.678,0.001"));
}

TEST(GonioCsv, AnEmptyFieldIsAHole) {
  const SampleTable table =
      parse(header("brdf", "deg", "theta_i,phi_i,theta_o,phi_o,R,G,sigma_R,sigma_G,weight") +
            "10,0,10,0,,2,,.1,1\n10,0,10,0,,,,,\n10,0,10,0,1,2,.1,.2,0\n");
  EXPECT_TRUE(std::isnan(table.values[0][0]));
  EXPECT_EQ(table.values[1][0], 2);
  EXPECT_THAT(table.mask, ElementsAre(MaskReason::none, MaskReason::hole, MaskReason::none));
  EXPECT_TRUE(std::isnan(table.sigma[0][0]));
  EXPECT_EQ(table.weight[1], 0);
}

TEST(GonioCsv, MasksTheHorizon) {
  const SampleTable table = parse(header("brdf_cos", "deg", "theta_i,phi_i,theta_o,phi_o,R") +
                                  "90,0,10,0,1\n90.0000009,0,10,0,1\n10,0,90,0,1\n"
                                  "10,0,89.9999995,0,1\n10,0,89.99999,0,1\n89.99999,0,10,0,1\n");
  EXPECT_THAT(table.mask, ElementsAre(MaskReason::horizon, MaskReason::horizon, MaskReason::horizon,
                                      MaskReason::horizon, MaskReason::none, MaskReason::none));
  EXPECT_TRUE(std::isnan(table.values[0][0])) << "f_r cos(theta_i) tells no f_r at the horizon";
  EXPECT_TRUE(std::isnan(table.values[0][1]));
  EXPECT_TRUE(std::isfinite(table.values[0][2]));
  // 1 / cos(89.99999 deg) = 1 / sin(1e-5 deg)
  EXPECT_NEAR(table.values[0][5] * (1e-5 * pi / 180), 1, 1e-8);
  // Files print pi/2 rounded up.
  const SampleTable radians =
      parse(header("brdf", "rad", "theta_i,phi_i,theta_o,phi_o,R") + "0,0,1.5707963268,0,1\n");
  EXPECT_THAT(radians.mask, ElementsAre(MaskReason::horizon));
}

TEST(GonioCsv, KeepsTheAngleTextOnRequest) {
  const std::string text =
      header("brdf", "rad", "R,phi_o,theta_o,phi_i,theta_i") + "1, +0.10 ,0.20,3e-1,.40\r\n";
  EXPECT_TRUE(parse(text).angle_text.empty());
  const SampleTable table = parse(text, {.keep_angle_text = true});
  EXPECT_THAT(table.angle_text, ElementsAre(".40,3e-1,0.20,+0.10"));
  EXPECT_EQ(written(table),
            "# gonio-table 1\n# quantity: brdf\n# angles: rad\n"
            "theta_i,phi_i,theta_o,phi_o,R\n.40,3e-1,0.20,+0.10,1\n");
}

TEST(GonioCsv, GivesTheSameBitsForAnyNumberOfThreads) {
  const std::string text = big_table(60000);
  ASSERT_GT(text.size(), 5u << 20) << "several blocks of 1 MiB";
  const table::ReadOptions one{.keep_angle_text = true, .threads = 1};
  const SampleTable expected = parse(text, one);
  EXPECT_EQ(expected.size(), 60000u);
  for (const int threads : {2, 3, 8, 0}) {
    const SampleTable table = parse(text, {.keep_angle_text = true, .threads = threads});
    EXPECT_EQ(bits(table.wi.x), bits(expected.wi.x));
    EXPECT_EQ(bits(table.wo.z), bits(expected.wo.z));
    EXPECT_EQ(bits(table.values[0]), bits(expected.values[0]));
    EXPECT_EQ(bits(table.sigma[0]), bits(expected.sigma[0]));
    EXPECT_EQ(table.weight, expected.weight);
    EXPECT_EQ(table.mask, expected.mask);
    EXPECT_EQ(table.angle_text, expected.angle_text);
  }
}

TEST(GonioCsv, ReportsTheFirstBadLineWhateverTheThreads) {
  std::string text = big_table(60000);
  // Two bad rows in the last third, one at the very end; the first of them has to be named.
  const std::size_t first = text.find('\n', 2 * text.size() / 3) + 1;
  text.insert(first, "10,0,91,0,1,1,1\n");
  text.insert(text.find('\n', first + (1u << 20)) + 1, "short\n");
  text += "10,0,nan,0,1,1,1\n";
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(first), '\n');
  for (const int threads : {1, 2, 4, 4, 4, 0}) {
    try {
      parse(text, {.threads = threads});
      FAIL() << "accepted";
    } catch (const table::FileError& error) {
      EXPECT_THAT(error.what(),
                  HasSubstr(fmt::format("t.csv:{}: column 'theta_o': found '91'", line)));
    }
  }
}

}  // namespace
}  // namespace gonio::tests
