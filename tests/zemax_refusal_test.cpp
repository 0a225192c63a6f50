// Zemax tabular BSDFs that are refused, and what the message says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "table/file_error.h"
#include "table/formats/zemax.h"
#include "table/sample_table.h"
#include "tests/zemax_text.h"

namespace gonio::tests {
namespace {

using table::GriddedTable;
using table::MaskReason;
using table::SampleTable;
using testing::AllOf;
using testing::HasSubstr;
using zemax::directions;
using zemax::ones;
using zemax::refusal;
using zemax::steps;
using zemax::Text;

const std::string small =
    "Symmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\n"
    "SampleRotation 1\n0\nAngleOfIncidence 1\n10\nScatterAzimuth 2\n0 180\nScatterRadial 3\n"
    "0 10 20\n\nMonochrome\nDataBegin\nTIS 0.1\n1 2 3\n4 5 6\nDataEnd\n";

/// `small` with a piece replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = small;
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

TEST(ZemaxRefusal, NamesWhatTheHeaderLacksOrContradicts) {
  ASSERT_EQ(refusal(small), "accepted");
  for (const std::string keyword :
       {"Symmetry PlaneSymmetrical\n", "SpectralContent Monochrome\n", "ScatterType BRDF\n",
        "SampleRotation 1\n0\n", "AngleOfIncidence 1\n10\n", "ScatterAzimuth 2\n0 180\n",
        "ScatterRadial 3\n0 10 20\n"}) {
    EXPECT_THAT(refusal(with(keyword, "")),
                AllOf(HasSubstr("t.bsdf:"), HasSubstr("found 'Monochrome'"),
                      HasSubstr("keyword " + keyword.substr(0, keyword.find(' ')))));
    EXPECT_THAT(refusal(with(keyword, keyword + keyword)), HasSubstr("stands twice"));
  }
  EXPECT_THAT(refusal(with("ScatterType BRDF", "ScatterType BTDF")),
              AllOf(HasSubstr("t.bsdf:3: found 'ScatterType BTDF', expected ScatterType BRDF")));
  EXPECT_THAT(refusal(with("PlaneSymmetrical", "Cubic")), HasSubstr("expected Symmetry Plane"));
  EXPECT_THAT(refusal(with("Content Monochrome", "Content Lab")), HasSubstr("Monochrome or XYZ"));
  EXPECT_THAT(refusal(with("Content Monochrome", "Content XYZ")),
              HasSubstr("found 'Monochrome', expected the data of TristimulusX"));
  EXPECT_THAT(refusal(with("\nMonochrome", "\nTristimulusX")),
              HasSubstr("expected the data of Monochrome"));
}

TEST(ZemaxRefusal, NamesWhatIsWrongWithAList) {
  EXPECT_THAT(refusal(with("Radial 3", "Radial 4")),
              AllOf(HasSubstr("t.bsdf:13: found 'Monochrome', expected 4 angles of ScatterRadial"),
                    HasSubstr("3 were read")));
  EXPECT_THAT(refusal(with("Radial 3", "Radial 2")), HasSubstr("'20' follows 2 angles"));
  EXPECT_THAT(refusal(with("Radial 3", "Radial 1e300")), HasSubstr("3 were read"));
  EXPECT_THAT(refusal(with("Radial 3", "Radial")), HasSubstr("the number of angles"));
  for (const std::string bad : {"0", "-3", "2.5"}) {
    EXPECT_THAT(refusal(with("Radial 3", "Radial " + bad)), HasSubstr("expected a whole number"));
  }
  for (const std::string bad : {"ten", "nan", "inf", "1e999", "10,5", "1e"}) {
    EXPECT_THAT(refusal(with("0 10 20", "0 " + bad + " 20")),
                AllOf(HasSubstr("t.bsdf:11: ScatterRadial: found '" + bad + "'"),
                      HasSubstr("expected a finite number")));
  }
  EXPECT_THAT(refusal(with("0 10 20", "0 10 10")), HasSubstr("expected ascending angles"));
  EXPECT_THAT(refusal(with("0 10 20", "0 20 10")), HasSubstr("10 deg follows 20 deg"));
  EXPECT_THAT(refusal(with("0 10 20", "0 10 181")), HasSubstr("181 deg, expected 0 to 180 deg"));
  EXPECT_THAT(refusal(with("0 10 20", "-5 10 20")), HasSubstr("-5 deg, expected 0 to 180"));
  EXPECT_THAT(refusal(with("Incidence 1\n10", "Incidence 1\n91")), HasSubstr("expected 0 to 90"));
  EXPECT_THAT(refusal(with("0 180", "-90 300")), HasSubstr("no more than a turn"));
}

TEST(ZemaxRefusal, NamesWhatIsWrongWithTheData) {
  EXPECT_THAT(refusal(with("DataBegin\n", "")), HasSubstr("found 'TIS 0.1', expected DataBegin"));
  EXPECT_THAT(refusal(with("TIS 0.1\n", "")), HasSubstr("found '1 2 3', expected TIS"));
  EXPECT_THAT(refusal(with("TIS 0.1", "TIS high")), HasSubstr("TIS: found 'high'"));
  EXPECT_THAT(refusal(with("TIS 0.1", "TIS")), HasSubstr("TIS: found ''"));
  EXPECT_THAT(refusal(with("TIS 0.1", "TIS 0.1 2")), HasSubstr("one number behind TIS"));
  EXPECT_THAT(refusal(with("4 5 6\n", "")),
              AllOf(HasSubstr("t.bsdf:17: found 'DataEnd', expected 3 values for azimuth 180"),
                    HasSubstr("rotation 0 and incidence 10")));
  EXPECT_THAT(refusal(with("4 5 6\n", "4 5\n")), HasSubstr("found 2 values, expected 3"));
  EXPECT_THAT(refusal(with("4 5 6\n", "4 5 6 7\n")), HasSubstr("'7' follows 3 values"));
  EXPECT_THAT(refusal(with("4 5 6\n", "4 5 6\n7 8 9\n")),
              HasSubstr("t.bsdf:18: found '7 8 9', expected DataEnd"));
  EXPECT_THAT(refusal(with("DataEnd\n", "")), HasSubstr("found the end of the file"));
  EXPECT_THAT(refusal(small + "4 5 6\n"), HasSubstr("expected nothing behind the data"));
  for (const std::string bad : {"nan", "-inf", "1e999", "x", "4;5"}) {
    EXPECT_THAT(refusal(with("4 5", "4 " + bad)), HasSubstr("expected a finite number"));
    EXPECT_THAT(refusal(with("4 5", bad + " 5")), testing::Not("accepted"));
  }
}

TEST(ZemaxRefusal, ListsThatDeclareMoreThanTheFileHoldsAreNotAllocated) {
  Text text;
  text.symmetry = "Asymmetrical4D";
  text.rotations = steps(0, 359.96, 0.05);
  text.incidences = steps(0, 89.99, 0.01);
  text.azimuths = text.rotations;
  text.radials = text.incidences;  // 4e15 values
  EXPECT_THAT(refusal(text.header("Monochrome") + "Monochrome\nDataBegin\nTIS 1\n1 2 3\n"),
              HasSubstr("values, more than the rest of the file can hold"));
}

TEST(ZemaxRefusal, WhateverTheBytesItIsATableOrAFileError) {
  Text text;
  text.rotations = {0, 90};
  text.azimuths = {0, 90, 180};
  text.radials = {0, 45, 90, 135};
  const std::string whole = text.header("XYZ") + text.block("TristimulusX", ones) +
                            text.block("TristimulusY", ones) + text.block("TristimulusZ", ones);
  std::mt19937 random(11);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  int accepted = 0;
  for (int k = 0; k < 500; ++k) {
    std::string content = whole;
    switch (k % 4) {
      case 0:
        content.resize(below(content.size()));
        break;
      case 1:
        for (int i = 0; i < 3; ++i) content[below(content.size())] = static_cast<char>(random());
        break;
      case 2:
        content.insert(content.find_first_of("0123456789", below(content.size() - 20)),
                       std::string(1 + below(20), '9'));
        break;
      default:
        content.erase(below(content.size()), below(40));
    }
    try {
      const SampleTable t = table::read_zemax(content, "t.bsdf", {});
      const GriddedTable grid = table::read_zemax_grid(content, "t.bsdf");
      EXPECT_EQ(t.size(), t.weight.size());
      std::vector<double> f_r(grid.channels.size());
      grid.f_r(directions(0, 30, 30, 10).first, directions(0, 30, 30, 10).second, f_r);
      for (std::size_t i = 0; i < t.size(); ++i) {
        ASSERT_EQ(std::isfinite(t.values[0][i]), t.mask[i] == MaskReason::none);
        ASSERT_GE(t.weight[i], 0);
      }
      ++accepted;
    } catch (const table::FileError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(accepted, 20);
  EXPECT_LT(accepted, 480);
}

}  // namespace
}  // namespace gonio::tests
