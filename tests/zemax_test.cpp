// Zemax tabular BSDFs: where their samples stand, which were measured, what each weighs; on made-up
// texts whose truth is known.
#include "table/formats/zemax.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "table/file_error.h"
#include "table/sample_table.h"
#include "tests/zemax_text.h"

namespace gonio::tests {
namespace {

using brdf::Direction;
using table::MaskReason;
using table::SampleTable;
using testing::ElementsAre;
using testing::HasSubstr;
using zemax::count;
using zemax::degree;
using zemax::directions;
using zemax::ones;
using zemax::parse;
using zemax::Reflectance;
using zemax::steps;
using zemax::Text;

TEST(Zemax, SamplesStandAboutTheMirrorDirectionOfATurnedSample) {
  Text text;
  text.symmetry = "Asymmetrical4D";
  text.rotations = {0, 35, 90};
  text.azimuths = steps(0, 360, 30);
  const SampleTable t = parse(text.monochrome(
      [](double r, double i, double a, double d) { return r + i / 100 + a / 1e5 + d / 1e8; }));
  EXPECT_EQ(t.name, "velvet");
  EXPECT_EQ(t.provenance.format, "Zemax tabular BSDF");
  EXPECT_THAT(t.channels, ElementsAre("mono"));
  ASSERT_EQ(t.size(), 3u * 2 * 13 * 13);
  std::size_t k = 0;
  for (const double r : text.rotations) {
    for (const double i : text.incidences) {
      for (const double a : text.azimuths) {
        for (const double d : text.radials) {
          const auto [wi, wo] = directions(r, i, a, d);
          ASSERT_NEAR(t.wi.x[k], wi.x, 1e-15);
          ASSERT_NEAR(t.wi.y[k], wi.y, 1e-15);
          ASSERT_NEAR(t.wi.z[k], wi.z, 1e-15);
          ASSERT_NEAR(t.wo.x[k], wo.x, 1e-15);
          ASSERT_NEAR(t.wo.y[k], wo.y, 1e-15);
          ASSERT_NEAR(t.wo.z[k], wo.z, 1e-15);
          ASSERT_EQ(t.mask[k], wo.z > 1e-9 ? MaskReason::none : MaskReason::horizon);
          if (wo.z > 1e-9) {
            ASSERT_DOUBLE_EQ(t.values[0][k], r + i / 100 + a / 1e5 + d / 1e8);
          } else {
            ASSERT_TRUE(std::isnan(t.values[0][k]));
          }
          ++k;
        }
      }
    }
  }
  EXPECT_THAT(t.notes, ElementsAre(HasSubstr("the sense of SampleRotation is not known")));
  // Azimuth 0 leads from the mirror direction towards the normal.
  EXPECT_GT(t.wo.z[1], t.wo.z[0]);
}

TEST(Zemax, TristimulusBlocksAreChannelsInWhateverOrderAndCase) {
  const Text text;
  const auto of = [](double scale) {
    return [scale](double, double i, double a, double d) { return scale * (i + a + d); };
  };
  std::string content = text.header("xyz") + text.block("Tristimulus Y", of(2)) + "\n# next\n" +
                        text.block("TRISTIMULUSX", of(1)) + text.block("tristimulusz", of(4));
  const SampleTable t = parse(content);
  EXPECT_THAT(t.channels, ElementsAre("X", "Y", "Z"));
  EXPECT_EQ(t.values[0][1], 30);
  EXPECT_EQ(t.values[1][1], 60);
  EXPECT_EQ(t.values[2][1], 120);
  // The same with the line ends of another system, blanks, letters and wrapped lists.
  std::string other;
  for (const char c : content) other += c == '\n' ? "  \r\n" : c == '\t' ? "  " : std::string(1, c);
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(other.find(from), std::string::npos);
    other.replace(other.find(from), from.size(), to);
  };
  replace("Symmetry", "\tSYMMETRY");
  replace("DataBegin", "databegin");
  replace("40  \r\n", "\r\n\r\n# wrapped\r\n 40\r\n");
  const SampleTable same = parse("\xEF\xBB\xBF" + other);
  EXPECT_EQ(same.size(), t.size());
  EXPECT_EQ(same.wo.x, t.wo.x);
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (t.mask[i] != MaskReason::none) continue;
    ASSERT_EQ(same.values[2][i], t.values[2][i]);
  }
}

TEST(Zemax, IsToldByItsKeywords) {
  EXPECT_TRUE(table::is_zemax("# x\n\n  scatterradial\t3"));
  EXPECT_TRUE(table::is_zemax("SOURCE Measured\r\nSymmetry x\r\nScatterType\r\n"));
  EXPECT_FALSE(table::is_zemax(""));
  EXPECT_FALSE(table::is_zemax("Source Measured\nVARS theta_i,phi_i,theta_s,phi_s,R\n"));
  EXPECT_FALSE(table::is_zemax("SourceOf\nScatterType BRDF\n"));
  EXPECT_FALSE(table::is_zemax(std::string("tensor_file\0\1\0", 14)));
  EXPECT_FALSE(table::is_zemax("# gonio-table 1\n# quantity: brdf\n"));
}

// What was measured --------------------------------------------------------------------------

/// Every sample's reason by its azimuth and radial angle, of a text with one incidence.
std::map<std::pair<double, double>, MaskReason> reasons(const Text& text, const Reflectance& f) {
  const SampleTable t = parse(text.monochrome(f));
  std::map<std::pair<double, double>, MaskReason> result;
  std::size_t i = 0;
  for (const double a : text.azimuths) {
    for (const double d : text.radials) result[{a, d}] = t.mask[i++];
  }
  return result;
}

double theta_o_deg(double incidence, double azimuth, double radial) {
  return std::acos(directions(0, incidence, azimuth, radial).second.z) / degree;
}

TEST(Zemax, ZerosBeyondTheLastPolarAngleAreNoMeasurements) {
  Text text;
  text.incidences = {35};
  // The limit is nowhere a node; beyond it a few samples above the horizon are left.
  for (const double limit : {52.0, 71.0, 84.0}) {
    const auto mask = reasons(text, [&](double, double i, double a, double d) {
      return theta_o_deg(i, a, d) < limit ? 0.25 : 0.0;
    });
    std::size_t padding = 0;
    for (const auto& [at, reason] : mask) {
      const double theta = theta_o_deg(35, at.first, at.second);
      const auto expected = theta > 90 - 1e-6 ? MaskReason::horizon
                            : theta > limit   ? MaskReason::padding
                                              : MaskReason::none;
      EXPECT_EQ(reason, expected) << limit << ": " << at.first << ", " << at.second;
      padding += reason == MaskReason::padding ? 1 : 0;
    }
    EXPECT_GE(padding, 3u);
  }
}

TEST(Zemax, AZeroBetweenValuesIsData) {
  Text text;
  text.incidences = {35};
  const auto mask = reasons(text, [](double, double, double a, double d) {
    return (a == 60 && d == 30) || (a == 90 && (d == 10 || d == 20)) ? 0.0 : 0.5;
  });
  for (const auto& [at, reason] : mask) EXPECT_NE(reason, MaskReason::padding);
  EXPECT_EQ(mask.at({60, 30}), MaskReason::none);
  EXPECT_EQ(mask.at({90, 20}), MaskReason::none);
}

TEST(Zemax, ASingleZeroAtTheLargestPolarAngleIsData) {
  // Listed twice, as azimuth 0 and 360: still one reading.
  Text text;
  text.symmetry = "Asymmetrical";
  text.incidences = {60};
  text.azimuths = steps(0, 360, 90);
  text.radials = {0, 40, 120};  // azimuth 0, radial 120: theta_o = 60 deg on the lamp's side
  const auto mask = reasons(text, [](double, double, double a, double d) {
    return d == 120 && (a == 0 || a == 360) ? 0.0 : 0.5;
  });
  EXPECT_EQ(mask.at({0, 120}), MaskReason::none);
  EXPECT_EQ(mask.at({360, 120}), MaskReason::none);
}

TEST(Zemax, RowsMayEndWhereOthersStillHaveReadings) {
  Text text;
  text.incidences = {70};
  text.radials = steps(0, 180, 10);
  // Azimuth 0 passes over the normal to the lamp's side, where nothing beyond 60 deg was measured;
  // the other side has readings up to 80 deg.
  const auto mask = reasons(text, [](double, double i, double a, double d) {
    return d <= 130 && theta_o_deg(i, a, d) < 80.001 ? 0.25 : 0.0;
  });
  EXPECT_EQ(mask.at({0, 130}), MaskReason::none);
  EXPECT_EQ(mask.at({0, 140}), MaskReason::padding);
  EXPECT_EQ(mask.at({0, 150}), MaskReason::padding);
  EXPECT_EQ(mask.at({0, 160}), MaskReason::horizon);
  EXPECT_EQ(mask.at({180, 10}), MaskReason::none);
}

TEST(Zemax, PaddingIsNotANumberAndANoteCountsIt) {
  Text text;
  text.incidences = {0, 10};
  text.radials = {0, 30, 60, 70, 80};
  const SampleTable t = parse(
      text.monochrome([](double, double, double, double d) { return d > 60 ? 0.0 : -0.125; }));
  // At incidence 10 deg, theta_o of radial 80 is 90 deg or more from azimuth 150 deg on or so.
  EXPECT_EQ(count(t, MaskReason::padding) + count(t, MaskReason::horizon), 2u * 2 * 7);
  EXPECT_THAT(
      t.notes,
      ElementsAre(HasSubstr(fmt::format("{} samples are zeros", count(t, MaskReason::padding)))));
  for (std::size_t i = 0; i < t.size(); ++i) {
    EXPECT_EQ(std::isnan(t.values[0][i]), t.mask[i] != MaskReason::none);
  }
}

// Weights ------------------------------------------------------------------------------------

/// The weighted mean of f over a block of samples that are all data or at the horizon.
double mean(const SampleTable& t, std::size_t first, std::size_t size,
            const std::function<double(const Direction<double>&)>& f) {
  double sum = 0;
  double weights = 0;
  for (std::size_t i = first; i < first + size; ++i) {
    if (t.mask[i] != MaskReason::none) continue;
    sum += t.weight[i] * f(t.wo[i]);
    weights += t.weight[i];
  }
  return sum / weights;
}

TEST(Zemax, WeightsAreSolidAngles) {
  Text text;
  text.incidences = {0, 25, 50};
  text.azimuths = steps(0, 180, 3);
  text.radials = steps(0, 180, 1);
  const SampleTable t = parse(text.monochrome(ones));
  const std::size_t block = text.azimuths.size() * text.radials.size();
  for (std::size_t i = 0; i < 3; ++i) {
    // Over the hemisphere: of cos 1/2, of its square 1/3, as across the plane of incidence. At
    // normal incidence the last half degree above the horizon belongs to masked samples: that
    // makes 0.0044 of the first.
    EXPECT_NEAR(mean(t, i * block, block, [](const auto& wo) { return wo.z; }), 1. / 2, 0.005);
    EXPECT_NEAR(mean(t, i * block, block, [](const auto& wo) { return wo.z * wo.z; }), 1. / 3,
                .005);
    EXPECT_NEAR(mean(t, i * block, block, [](const auto& wo) { return wo.y * wo.y; }), 1. / 3,
                .005);
  }
  // wi: bounds at 0, 12.5, 37.5 and 62.5 deg.
  EXPECT_NEAR(t.weight[block + 7] / t.weight[7],
              (std::cos(12.5 * degree) - std::cos(37.5 * degree)) / (1 - std::cos(12.5 * degree)),
              1e-12);
}

TEST(Zemax, OneSideWeighsAsHalfOfBoth) {
  Text one;
  one.azimuths = {0, 10, 40, 90, 135, 180};
  Text both = one;
  both.symmetry = "Asymmetrical";
  both.azimuths = {0, 10, 40, 90, 135, 180, 225, 270, 320, 350, 360};
  const SampleTable a = parse(one.monochrome(ones));
  const SampleTable b = parse(both.monochrome(ones));
  const std::size_t radials = one.radials.size();
  const std::size_t last = both.azimuths.size() - 1;
  for (std::size_t k = 0; k < one.azimuths.size(); ++k) {
    for (std::size_t d = 0; d < radials; ++d) {
      const double of_both =
          b.weight[k * radials + d] + (k == 5 ? 0 : b.weight[(last - k) * radials + d]);
      EXPECT_NEAR(2 * a.weight[k * radials + d], of_both, 1e-14);
    }
  }
}

TEST(Zemax, ARotationByAWholeTurnIsCountedOnce) {
  Text closed;
  closed.symmetry = "Asymmetrical4D";
  closed.azimuths = steps(0, 360, 60);
  closed.rotations = steps(0, 360, 45);
  Text open = closed;
  open.rotations.pop_back();
  const SampleTable a = parse(closed.monochrome(ones));
  const SampleTable b = parse(open.monochrome(ones));
  const std::size_t last = b.size();
  const std::size_t block = a.size() - last;
  for (std::size_t i = 0; i < block; ++i) {
    EXPECT_NEAR(a.weight[i] + a.weight[last + i], b.weight[i], 1e-14);
    EXPECT_NEAR(a.weight[block + i], b.weight[block + i], 1e-14);
  }
}

}  // namespace
}  // namespace gonio::tests
