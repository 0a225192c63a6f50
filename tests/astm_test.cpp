// ASTM text: its columns, units and notes, and the ramp that instruments write where they did not
// measure, on real paints and on synthetic tables whose truth is known.
#include "table/formats/astm.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "table/file_error.h"
#include "table/read.h"
#include "tests/real_data.h"

namespace gonio::tests {
namespace {

using table::AngleUnit;
using table::MaskReason;
using table::SampleTable;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double pi = std::numbers::pi;
constexpr double degree = pi / 180;

SampleTable parse(const std::string& content) {
  EXPECT_TRUE(table::is_astm(content)) << content.substr(0, 200);
  return table::read_astm(content, "t.astm", {});
}

std::string refusal(const std::string& content) {
  try {
    parse(content);
  } catch (const table::FileError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "accepted";
}

double theta_o_deg(const SampleTable& table, std::size_t i) {
  const auto wo = table.wo[i];
  return std::atan2(std::hypot(wo.x, wo.y), wo.z) / degree;
}

const std::string start = "LAB_NAME somewhere\nMEAS_NAME BRDF\n";

/// f_r of theta_i, theta_o and phi_o in degrees.
using Reflectance = std::function<double(double, double, double)>;

/// Two incidence angles, exitant meridians by 30 deg, polar angles by 5 deg up to the horizon.
std::string goniometer_text(const Reflectance& f) {
  std::string text = start + "VARS theta_i,phi_i,theta_s,phi_s,R,G\n";
  for (const int theta_i : {0, 30}) {
    for (int phi = 0; phi < 360; phi += 30) {
      for (int theta = 0; theta <= 90; theta += 5) {
        const double value = f(theta_i, theta, phi);
        text += fmt::format("{},{},{},{},{},{}\n", theta_i * degree, pi, theta * degree,
                            phi * degree, value, 3 * value);
      }
    }
  }
  return text;
}

double lobe(double theta_i, double theta_o, double phi_o) {
  const double along = theta_o * std::cos(phi_o * degree) - theta_i;
  const double across = theta_o * std::sin(phi_o * degree);
  return 0.2 + std::exp(-(along * along + across * across) / 400);
}

TEST(Astm, ReadsCommasAndBlanksAndAnyOrder) {
  const SampleTable commas = parse(start +
                                   "VARS theta_i,phi_i,theta_s,phi_s,465nm,525nm\n"
                                   "0.5,3.1,0.25,0,1.5,2.5\n");
  EXPECT_THAT(commas.channels, ElementsAre("465nm", "525nm"));
  EXPECT_THAT(commas.values, ElementsAre(ElementsAre(1.5), ElementsAre(2.5)));
  EXPECT_EQ(commas.wi.z[0], std::cos(.5));
  EXPECT_EQ(commas.wo.x[0], std::sin(.25));
  EXPECT_EQ(commas.provenance.format, "ASTM text");
  const SampleTable blanks = parse(start +
                                   "VARS 525nm  phi_r theta_r 465nm\tphi_i theta_i\r\n\r\n"
                                   "  2.5   0 0.25\t1.5 3.1 0.5  \r\n");
  EXPECT_THAT(blanks.channels, ElementsAre("525nm", "465nm"));
  EXPECT_THAT(blanks.values, ElementsAre(ElementsAre(2.5), ElementsAre(1.5)));
  EXPECT_EQ(blanks.wi.x, commas.wi.x);
  EXPECT_EQ(blanks.wo.x, commas.wo.x);
}

TEST(Astm, TellsRadiansFromDegreesAndSaysSo) {
  const std::string columns = "VARS theta_i,phi_i,theta_o,phi_o,R\n";
  const SampleTable radians = parse(start + columns + "0,0,1.5707963268,6.2831853072,1\n");
  EXPECT_EQ(radians.provenance.angles, AngleUnit::radians);
  EXPECT_THAT(radians.notes, Contains(HasSubstr("taken as radians")));
  const SampleTable degrees = parse(start + columns + "0,0,1,6.5,1\n");
  EXPECT_EQ(degrees.provenance.angles, AngleUnit::degrees);
  EXPECT_THAT(degrees.notes, Contains(HasSubstr("taken as degrees")));
  EXPECT_EQ(parse(start + columns + "0,0,60,0,1\n").provenance.angles, AngleUnit::degrees);
  // A unit in the header decides, where the range would have said radians.
  const SampleTable named = parse(start + "ANGLE_UNITS Degrees\n" + columns + "0,0,1,1,1\n");
  EXPECT_EQ(named.provenance.angles, AngleUnit::degrees);
  EXPECT_NEAR(named.wo.z[0], std::cos(degree), 1e-16);
  EXPECT_THAT(named.notes, Contains(HasSubstr("as the header says")));
  const SampleTable bracketed =
      parse(start + "VARS theta_i(deg),phi_i(deg),theta_s(deg),phi_s(deg),R\n0,0,1,1,1\n");
  EXPECT_EQ(bracketed.provenance.angles, AngleUnit::degrees);
}

TEST(Astm, RestoresAnAzimuthThatVarsOmits) {
  const SampleTable table = parse(start + "VARS theta_i,phi_i,theta_s,465nm\n0.1,3.1,0.2,1.5,7\n");
  EXPECT_THAT(table.channels, ElementsAre("465nm"));
  EXPECT_THAT(table.values[0], ElementsAre(7));
  EXPECT_EQ(table.wo.y[0], std::sin(.2) * std::sin(1.5));
  EXPECT_THAT(table.notes, Contains(HasSubstr("taken as phi_s")));
  // Two numbers too many, or another angle missing: nothing to deduce.
  EXPECT_THAT(refusal(start + "VARS theta_i,phi_i,theta_s,465nm\n0.1,3.1,0.2,1.5,7,8\n"),
              HasSubstr("t.astm:3: VARS: no column 'phi_o'"));
  EXPECT_THAT(refusal(start + "VARS theta_i,theta_s,phi_s,465nm\n0.1,3.1,0.2,1.5,7\n"),
              HasSubstr("t.astm:3: VARS: no column 'phi_i'"));
}

TEST(Astm, TakesNameAndCountFromTheHeader) {
  const SampleTable table = parse(
      "LAB_NAME M\xFCnchen \xB0\nSAMPLE_NAME rolled brass\nMEAS_NAME brdf\nNUM_POINTS 3\n"
      "VARS theta_i,phi_i,theta_s,phi_s,R\n0,0,0.1,0,1\n0,0,0.2,0,1\n");
  EXPECT_EQ(table.name, "rolled brass");
  EXPECT_THAT(table.notes, Contains(HasSubstr("NUM_POINTS says 3 but the file has 2 rows")));
  const SampleTable counted = parse(start +
                                    "NUM_POINTS 1\nVARS theta_i,phi_i,theta_s,phi_s,R\n"
                                    "0,0,0.1,0,1\n");
  EXPECT_THAT(counted.notes, Each(Not(HasSubstr("NUM_POINTS"))));
  EXPECT_THAT(refusal("MEAS_NAME BTDF\nVARS theta_i,phi_i,theta_s,phi_s,R\n0,0,0.1,0,1\n"),
              HasSubstr("t.astm:1: MEAS_NAME is 'BTDF', expected BRDF"));
}

TEST(Astm, RefusesBadRowsInTheSameWordsAsCsv) {
  const std::string head = start + "VARS theta_i,phi_i,theta_s,phi_s,R\n0,0,0.1,0,1\n";
  EXPECT_THAT(refusal(head + "0,0,0.1,0\n"), HasSubstr("t.astm:5: found 4 fields"));
  EXPECT_THAT(refusal(head + "0,0,0.1,0,x\n"),
              HasSubstr("t.astm:5: column 'R': found 'x', expected a number"));
  EXPECT_THAT(refusal(head + "0,0,-0.1,0,1\n"),
              HasSubstr("column 'theta_s': found '-0.1', expected 0 to pi/2"));
  EXPECT_THAT(refusal(head + "0,0,nan,0,1\n"), HasSubstr("column 'theta_s': found 'nan'"));
  EXPECT_THAT(refusal(start + "VARS theta_i phi_i theta_s phi_s R\n0 0 0.1 0 1\n0 0 .1 0 1 2\n"),
              HasSubstr("t.astm:5: found 6 fields"));
  EXPECT_THAT(refusal(start + "VARS theta_i,phi_i,theta_s,phi_s,R\n"), HasSubstr("no row"));
  EXPECT_THAT(refusal(start + "VARS theta_i,phi_i,theta_s,phi_s,R,R\n0,0,0.1,0,1,1\n"),
              HasSubstr("both named 'R'"));
}

TEST(Astm, IsToldFromOtherTexts) {
  EXPECT_FALSE(table::is_astm("theta_i,phi_i,theta_o,phi_o,R\n1,2,3,4,5\n"));
  EXPECT_FALSE(table::is_astm("1 2 3\nVARS a\n"));
  EXPECT_FALSE(table::is_astm("LAB_NAME x\nNUM_POINTS 1\n"));
  EXPECT_TRUE(table::is_astm("\xEF\xBB\xBF\nLAB_NAME x\n\nVARS a\n"));
}

TEST(Astm, MasksARampFromWhereverItStarts) {
  // Measured up to T, from there a straight fall to zero at the horizon.
  for (const double last : {60.0, 70.0}) {
    const SampleTable table = parse(goniometer_text([&](double ti, double to, double po) {
      return to <= last ? lobe(ti, to, po) : lobe(ti, last, po) * (90 - to) / (90 - last);
    }));
    std::size_t masked = 0;
    for (std::size_t i = 0; i < table.size(); ++i) {
      const bool beyond = theta_o_deg(table, i) > last + .1;
      EXPECT_EQ(table.mask[i] == MaskReason::extrapolated, beyond) << theta_o_deg(table, i);
      masked += beyond ? 1 : 0;
    }
    ASSERT_GT(masked, 0u);
    EXPECT_THAT(table.notes,
                Contains(testing::AllOf(HasSubstr(fmt::format("beyond theta_o = {} deg", last)),
                                        HasSubstr(fmt::format("{} samples are masked", masked)))));
  }
}

TEST(Astm, MasksARampThatMostMeridiansFollowOnlyLoosely) {
  // As in real files: exact on every third meridian, within 2 % on the others.
  const auto wobble = [](double to, double po) {
    return std::fmod(po, 90) == 0 ? 1 : 1 + 0.02 * std::sin(7 * to + po);
  };
  const auto ramp = [&](double ti, double to, double po) {
    return to <= 60 ? lobe(ti, to, po) : wobble(to, po) * lobe(ti, 60, po) * (90 - to) / 30;
  };
  const SampleTable table = parse(goniometer_text(ramp));
  EXPECT_EQ(std::count(table.mask.begin(), table.mask.end(), MaskReason::extrapolated), 2 * 12 * 6);
}

TEST(Astm, DoesNotTakeMeasurementsForARamp) {
  const std::vector<std::pair<const char*, Reflectance>> measured{
      {"constant", [](double, double, double) { return .3; }},
      {"a lobe", lobe},
      {"cosine", [](double, double to, double) { return std::cos(to * degree); }},
      {"straight to zero all the way", [](double, double to, double) { return (90 - to) / 90; }},
      {"zero at the end", [](double, double to, double) { return to < 60 ? 1. : 0.; }},
      {"a fall to zero on three meridians, a rise on the others",
       [](double, double to, double po) {
         if (to <= 60) return 1.;
         return po < 70 ? (90 - to) / 30 : to / 60;
       }},
      {"a ramp of three points only",
       [](double, double to, double) { return to <= 75 ? 1. : (90 - to) / 15; }},
  };
  for (const auto& [name, f] : measured) {
    const SampleTable table = parse(goniometer_text(f));
    EXPECT_EQ(std::count(table.mask.begin(), table.mask.end(), MaskReason::extrapolated), 0)
        << name;
    EXPECT_THAT(table.notes, Each(Not(HasSubstr("ramp")))) << name;
  }
}

TEST(Astm, ReadsEveryRealPaint) {
  GONIO_REAL_DATA_OR_SKIP(folder, "paints");
  std::size_t paints = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".astm") continue;
    ++paints;
    SCOPED_TRACE(entry.path().filename().string());
    const SampleTable table = table::read(entry.path().string());
    // Figures of the data's README: rows, bands, and 75 deg, beyond which nothing is measured.
    ASSERT_EQ(table.size(), 12964u);
    EXPECT_THAT(table.channels, ElementsAre("465nm", "525nm", "630nm"));
    EXPECT_EQ(table.provenance.angles, AngleUnit::radians);
    EXPECT_THAT(table.notes, Contains(HasSubstr("taken as phi_s")));
    EXPECT_THAT(table.notes, Contains(HasSubstr("beyond theta_o = 75 deg")));
    for (std::size_t i = 0; i < table.size(); ++i) {
      ASSERT_EQ(table.mask[i] == MaskReason::extrapolated, theta_o_deg(table, i) > 75.5);
      ASSERT_NEAR(table.wi.y[i], 0, 1e-14) << "phi_i = pi";
      ASSERT_LE(table.wi.x[i], 1e-14);
    }
  }
  EXPECT_EQ(paints, 22u);
}

TEST(Astm, ThePaintsMirrorPeakStandsAtTheMirrorDirection) {
  GONIO_REAL_DATA_OR_SKIP(path, "paints/C8_Silver.astm");
  const SampleTable table = table::read(path);
  // theta_i = 20 deg: off-specular shift is still small there.
  std::size_t peak = 0;
  double largest = 0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (std::abs(table.wi.z[i] - std::cos(20 * degree)) > 1e-9) continue;
    if (table.values[1][i] > largest) {
      largest = table.values[1][i];
      peak = i;
    }
  }
  // The mirror image of wi in the normal is (-x, -y, z).
  EXPECT_GT(table.wo.x[peak], 0) << "opposite to wi, whose x is negative";
  EXPECT_NEAR(table.wo.y[peak], 0, 1e-12);
  EXPECT_NEAR(theta_o_deg(table, peak), 20, 2.5);
}

}  // namespace
}  // namespace gonio::tests
