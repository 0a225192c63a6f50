// MERL files: coordinates, bins, and what is refused.
#include "table/formats/merl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "table/file_error.h"
#include "table/formats/half_difference.h"
#include "table/formats/merl_grid.h"
#include "table/input_file.h"
#include "tests/merl_reference.h"
#include "tests/real_data.h"

namespace gonio::tests {
namespace {

using brdf::Direction;
using merl_reference::any_direction;
using merl_reference::described_bin;
using table::HalfDifference;
using table::MaskReason;
using table::MerlGrid;
using table::SampleTable;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double pi = std::numbers::pi;

// Small files -------------------------------------------------------------------------------------

struct MerlBytes {
  std::array<std::int32_t, 3> sizes{3, 4, 5};
  std::vector<double> values;

  /// Values 1, 2, 3 .. in the order of the file.
  MerlBytes() : values(std::size_t{3} * 60) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i + 1);
  }
  double& at(std::size_t channel, std::size_t bin) { return values[channel * 60 + bin]; }

  std::string bytes() const {
    std::string result(sizeof sizes + values.size() * sizeof(double), '\0');
    std::memcpy(result.data(), sizes.data(), sizeof sizes);
    std::memcpy(result.data() + sizeof sizes, values.data(), values.size() * sizeof(double));
    return result;
  }
};

SampleTable read(const std::string& bytes, int threads = 1) {
  table::ReadOptions options;
  options.threads = threads;
  return table::read_merl(bytes, "small.binary", options);
}

std::string refusal(const std::string& bytes) {
  try {
    read(bytes);
  } catch (const table::FileError& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_THAT(message, testing::StartsWith("small.binary: "));
    return message;
  }
  return "accepted";
}

std::string header(std::int32_t a, std::int32_t b, std::int32_t c) {
  MerlBytes file;
  file.sizes = {a, b, c};
  return file.bytes().substr(0, 12);
}

TEST(Merl, BinsStandInTheOrderOfTheFileAtTheirNodes) {
  const SampleTable t = read(MerlBytes().bytes());
  ASSERT_EQ(t.size(), 60u);
  EXPECT_EQ(t.name, "small");
  EXPECT_THAT(t.channels, ElementsAre("R", "G", "B"));
  EXPECT_EQ(t.provenance.format, "MERL");
  EXPECT_THAT(t.notes, IsEmpty());
  for (std::size_t h = 0; h < 3; ++h) {
    for (std::size_t d = 0; d < 4; ++d) {
      for (std::size_t p = 0; p < 5; ++p) {
        const std::size_t i = p + 5 * (d + 4 * h);
        const auto bin = static_cast<double>(i);
        EXPECT_DOUBLE_EQ(t.values[0][i], (bin + 1) / 1500);
        EXPECT_DOUBLE_EQ(t.values[1][i], (bin + 61) * 1.15 / 1500);
        EXPECT_DOUBLE_EQ(t.values[2][i], (bin + 121) * 1.66 / 1500);
        const HalfDifference at = table::half_difference(t.wi[i], t.wo[i], 1e-9);
        EXPECT_NEAR(at.theta_h, pi / 2 * std::pow(static_cast<double>(h) / 3, 2), 1e-14);
        EXPECT_NEAR(at.phi_h, 0, 1e-14);
        EXPECT_NEAR(at.theta_d, pi / 2 * static_cast<double>(d) / 4, 1e-14);
        if (d == 0) continue;
        EXPECT_NEAR(at.phi_d, pi * static_cast<double>(p) / 5, 1e-14);
      }
    }
  }
}

TEST(Merl, NegativeValuesAreHolesOfTheirChannel) {
  MerlBytes file;
  file.at(1, 0) = -1;
  for (std::size_t c = 0; c < 3; ++c) file.at(c, 1) = -0.5;
  file.at(0, 2) = 0;
  // Row 11, theta_h 40 deg, theta_d 67.5 deg, phi_d 0: wi lies 17.5 deg below the horizon.
  const std::size_t below = 55;
  const SampleTable t = read(file.bytes());
  EXPECT_TRUE(std::isnan(t.values[1][0]));
  EXPECT_DOUBLE_EQ(t.values[0][0], 1.0 / 1500);
  EXPECT_EQ(t.mask[0], MaskReason::none);
  EXPECT_EQ(t.mask[1], MaskReason::hole);
  EXPECT_TRUE(std::isnan(t.values[0][1]));
  EXPECT_EQ(t.values[0][2], 0);
  EXPECT_EQ(t.mask[2], MaskReason::none);
  EXPECT_NEAR(t.wi[below].z, -std::sin(17.5 * pi / 180), 1e-14);
  EXPECT_EQ(t.mask[below], MaskReason::horizon);
  EXPECT_DOUBLE_EQ(t.values[0][below], static_cast<double>(below + 1) / 1500);
}

TEST(Merl, WeightsAreTheSolidAnglesOfTheBins) {
  const SampleTable t = read(MerlBytes().bytes());
  double sum = 0;
  for (const double w : t.weight) sum += w;
  EXPECT_NEAR(sum, 2 * pi, 1e-14);
  // 4 cos(theta_d) sin(theta_d) sin(theta_h) over the bin theta_h 1, theta_d 2, by midpoints.
  const MerlGrid grid{3, 4, 5};
  constexpr int steps = 200;
  double integral = 0;
  for (int a = 0; a < steps; ++a) {
    for (int b = 0; b < steps; ++b) {
      const double h = std::lerp(grid.theta_h(1), grid.theta_h(2), (a + 0.5) / steps);
      const double d = std::lerp(grid.theta_d(2), grid.theta_d(3), (b + 0.5) / steps);
      integral += 4 * std::cos(d) * std::sin(d) * std::sin(h);
    }
  }
  integral *= (grid.theta_h(2) - grid.theta_h(1)) * (grid.theta_d(3) - grid.theta_d(2)) *
              grid.phi_d(1) / (steps * steps);
  EXPECT_NEAR(t.weight[30], integral, 1e-5 * integral);
}

TEST(Merl, TrailingBytesAreReadWithANote) {
  const SampleTable t = read(MerlBytes().bytes() + "bye");
  EXPECT_EQ(t.size(), 60u);
  EXPECT_THAT(t.notes, ElementsAre(HasSubstr("3 bytes behind the last bin")));
}

TEST(Merl, RefusesWhatHoldsNoWholeGrid) {
  const std::string bytes = MerlBytes().bytes();
  EXPECT_THAT(refusal(bytes.substr(0, 11)), HasSubstr("11 bytes"));
  for (const std::size_t size : {std::size_t{12}, std::size_t{20}, bytes.size() - 1}) {
    EXPECT_THAT(refusal(bytes.substr(0, size)),
                AllOf(HasSubstr("ends at byte " + std::to_string(size)),
                      HasSubstr("expected 1452 bytes for 3 x 4 x 5 bins"), HasSubstr("get it")));
  }
  EXPECT_THAT(refusal(header(90, 90, 180)), HasSubstr("expected 34992012 bytes"));
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  EXPECT_THAT(refusal(header(most, most, most)), HasSubstr("no file can hold"));
  EXPECT_THAT(refusal(header(most, most, 1)), HasSubstr("no file can hold"));
  EXPECT_THAT(refusal(header(most, 2, 1)), HasSubstr("ends at byte 12"));
  EXPECT_THAT(refusal(header(90, 0, 180)), HasSubstr("90 x 0 x 180"));
  EXPECT_THAT(refusal(header(-90, -90, 180)), HasSubstr("-90 x -90 x 180"));
}

TEST(Merl, RefusesValuesThatAreNotFiniteAndNamesTheFirst) {
  MerlBytes file;
  file.at(2, 7) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(file.bytes()),
              HasSubstr("channel B, bin 7 (theta_h 0, theta_d 1, phi_d 2): found inf, expected a"));
  file.at(1, 33) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(file.bytes()),
              HasSubstr("channel G, bin 33 (theta_h 1, theta_d 2, phi_d 3): found nan"));
  file.at(0, 59) = -std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(file.bytes()), HasSubstr("channel R, bin 59"));
  EXPECT_THROW(table::read_merl_grid(file.bytes(), "small.binary"), table::FileError);
}

TEST(Merl, IsToldByItsSizes) {
  const std::string bytes = MerlBytes().bytes();
  EXPECT_TRUE(table::is_merl(bytes));
  EXPECT_TRUE(table::is_merl(bytes.substr(0, bytes.size() - 8)));
  EXPECT_TRUE(table::is_merl(bytes + "more"));
  EXPECT_TRUE(table::is_merl(header(90, 90, 180)));
  EXPECT_FALSE(table::is_merl(header(90, 90, 180).substr(0, 11)));
  EXPECT_FALSE(table::is_merl(bytes.substr(0, 100)));
  EXPECT_FALSE(table::is_merl(bytes + bytes + bytes));
  EXPECT_FALSE(table::is_merl(header(0, 1, 1)));
  EXPECT_FALSE(table::is_merl(header(90, 90, -180)));
  EXPECT_FALSE(table::is_merl("# gonio-table 1\n# quantity: brdf\n"));
  EXPECT_FALSE(table::is_merl("1 2 3 4 5 6\n"));
  EXPECT_FALSE(table::is_merl(""));
}

TEST(Merl, GivesTheSameBitsForAnyNumberOfThreads) {
  // More bins than one task takes.
  MerlBytes file;
  file.sizes = {20, 30, 40};
  file.values.resize(std::size_t{3} * 24000);
  std::mt19937 random(3);
  for (double& value : file.values) value = static_cast<double>(random() % 1000) - 50;
  const SampleTable one = read(file.bytes(), 1);
  const SampleTable four = read(file.bytes(), 4);
  EXPECT_EQ(one.mask, four.mask);
  EXPECT_EQ(one.weight, four.weight);
  EXPECT_EQ(one.wi.x, four.wi.x);
  EXPECT_EQ(one.wo.z, four.wo.z);
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_TRUE(one.values[1][i] == four.values[1][i] ||
                (std::isnan(one.values[1][i]) && std::isnan(four.values[1][i])));
  }
}

TEST(Merl, MutilatedFilesAreReadOrRefused) {
  std::mt19937 random(4);
  int refused = 0;
  for (int way = 0; way < 500; ++way) {
    std::string bytes = MerlBytes().bytes();
    if (way % 2 == 0) bytes.resize(random() % bytes.size());
    for (std::size_t flips = random() % 4; flips > 0 && !bytes.empty(); --flips) {
      // Half of them in the sizes.
      const std::size_t within =
          way % 4 < 2 ? std::min<std::size_t>(12, bytes.size()) : bytes.size();
      bytes[random() % within] = static_cast<char>(random());
    }
    table::is_merl(bytes);
    try {
      const SampleTable t = read(bytes);
      for (const auto& values : t.values) {
        for (const double f_r : values) EXPECT_FALSE(std::isinf(f_r));
      }
    } catch (const table::FileError&) {
      ++refused;
    }
  }
  EXPECT_GE(refused, 250);  // half are truncated
}

// Look-up -----------------------------------------------------------------------------------------

TEST(MerlLookup, IsConstantInABinAndUnknownBelowTheHorizon) {
  MerlBytes file;
  const std::size_t bin = 27;
  for (std::size_t c = 0; c < 3; ++c) file.at(c, bin + 5) = -1;
  const std::string bytes = file.bytes();
  const table::GriddedTable grid = table::read_merl_grid(bytes, "small.binary");
  EXPECT_THAT(grid.channels, ElementsAre("R", "G", "B"));
  EXPECT_EQ(grid.provenance.format, "MERL");
  const auto f_r = [&](const Direction<double>& wi, const Direction<double>& wo) {
    std::array<double, 3> result{};
    grid.f_r(wi, wo, result);
    return result;
  };
  // theta_h 10 .. 40 deg, theta_d 22.5 .. 45 deg, phi_d 72 .. 108 deg.
  for (const double part : {0.0, 0.5, 0.99}) {
    const HalfDifference at{.theta_h = (10 + 30 * part) * pi / 180,
                            .phi_h = 0.3,
                            .theta_d = (22.5 + 22.5 * part) * pi / 180,
                            .phi_d = (72 + 36 * part) * pi / 180};
    const auto [wi, wo] = table::directions_from(at);
    EXPECT_DOUBLE_EQ(f_r(wi, wo)[0], (static_cast<double>(bin) + 1) / 1500);
    EXPECT_DOUBLE_EQ(f_r(wo, wi)[2], (static_cast<double>(bin) + 121) * 1.66 / 1500);
  }
  const auto [wi, wo] =
      table::directions_from({.theta_h = 0.4, .theta_d = 50 * pi / 180, .phi_d = pi / 2});
  EXPECT_THAT(f_r(wi, wo), testing::Each(testing::IsNan()));  // the hole
  const Direction<double> up = brdf::direction_from_degrees(10, 0);
  EXPECT_THAT(f_r(up, brdf::direction_from_degrees(90, 40)), testing::Each(testing::IsNan()));
  EXPECT_THAT(f_r(brdf::direction_from_degrees(95, 40), up), testing::Each(testing::IsNan()));
}

// The real file -----------------------------------------------------------------------------------

TEST(MerlData, HasNoHolesAboveTheHorizon) {
  GONIO_REAL_DATA_OR_SKIP(path, "merl/gold-metallic-paint.nbrdf.binary");
  const table::InputFile file(path);
  const std::string_view bytes = file.bytes();
  ASSERT_TRUE(table::is_merl(bytes));
  const SampleTable t = table::read_merl(bytes, path, {});
  ASSERT_EQ(t.size(), 1'458'000u);
  EXPECT_THAT(t.notes, IsEmpty());
  const auto count = [&](MaskReason reason) {
    return std::count(t.mask.begin(), t.mask.end(), reason);
  };
  EXPECT_EQ(count(MaskReason::hole), 0);
  EXPECT_EQ(count(MaskReason::horizon), 346'570);  // counted by another program
  // wi = wo at the normal: bins of the first row hold one value.
  for (std::size_t i = 0; i < 180; ++i) EXPECT_NEAR(t.values[0][i], t.values[0][0], 1e-12);
  const table::GriddedTable grid = table::read_merl_grid(bytes, path);
  std::mt19937 random(6);
  for (int i = 0; i < 1000; ++i) {
    const Direction<double> wi = any_direction(random);
    const Direction<double> wo = any_direction(random);
    std::array<double, 3> f_r{};
    grid.f_r(wi, wo, f_r);
    double green = 0;
    std::memcpy(&green, bytes.data() + 12 + 8 * (1'458'000 + described_bin(wi, wo)), sizeof green);
    if (green < 0) {
      EXPECT_TRUE(std::isnan(f_r[1]));
    } else {
      EXPECT_EQ(f_r[1], green * (1.15 / 1500));
    }
  }
}

}  // namespace
}  // namespace gonio::tests
