// Tables as MERL files: what is kept, and that what is lost is said.
#include "table/formats/merl_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "table/file_error.h"
#include "table/formats/half_difference.h"
#include "table/formats/merl.h"
#include "table/formats/merl_grid.h"
#include "table/input_file.h"
#include "tests/real_data.h"

namespace gonio::tests {
namespace {

using table::HalfDifference;
using table::MaskReason;
using table::MerlLoss;
using table::SampleTable;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double radians = std::numbers::pi / 180;
constexpr std::size_t bin_count = 1'458'000;  // 90 x 90 x 180
constexpr std::size_t file_size = 12 + 24 * bin_count;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Written {
  std::string bytes;
  MerlLoss loss;

  double value(std::size_t channel, std::size_t bin) const {
    double result = 0;
    std::memcpy(&result, bytes.data() + 12 + 8 * (channel * bin_count + bin), sizeof result);
    return result;
  }
};

Written write(const SampleTable& table) {
  Written result;
  result.loss =
      table::write_merl(table, [&](std::string_view piece) { result.bytes.append(piece); });
  EXPECT_EQ(result.bytes.size(), file_size);
  return result;
}

std::string refusal(const SampleTable& table) {
  try {
    table::write_merl(table, [](std::string_view) { ADD_FAILURE() << "wrote something"; });
  } catch (const table::FileError& error) {
    return error.what();
  }
  return "accepted";
}

SampleTable table_of_channels(const std::vector<std::string>& channels) {
  SampleTable t;
  t.channels = channels;
  t.values.resize(channels.size());
  t.provenance.path = "scan.csv";
  return t;
}

void add(SampleTable& t, const HalfDifference& at, const std::array<double, 3>& f_r,
         MaskReason reason = MaskReason::none) {
  const auto [wi, wo] = table::directions_from(at);
  t.wi.push_back(wi);
  t.wo.push_back(wo);
  for (std::size_t c = 0; c < 3; ++c) t.values[c].push_back(f_r[c]);
  t.mask.push_back(reason);
}

/// Angles in degrees: theta_h_k is the bin, whose lower edge is 90 (k/90)^2 degrees.
HalfDifference at_node(int theta_h_bin, double theta_d, double phi_d) {
  const double part = theta_h_bin / 90.0;
  return {.theta_h = 90 * part * part * radians,
          .theta_d = theta_d * radians,
          .phi_d = phi_d * radians};
}

std::size_t bin(std::size_t theta_h, std::size_t theta_d, std::size_t phi_d) {
  return phi_d + 180 * (theta_d + 90 * theta_h);
}

TEST(MerlWriter, ASampleFillsTheBinOfItsDirections) {
  SampleTable t = table_of_channels({"R", "G", "B"});
  add(t, at_node(30, 20, 90), {0.5, 0.25, nan});
  add(t, at_node(5, 40, 200), {1, 2, 3});  // as phi_d = 20, with wi and wo swapped
  const Written written = write(t);
  std::array<std::int32_t, 3> sizes{};
  std::memcpy(sizes.data(), written.bytes.data(), sizeof sizes);
  EXPECT_THAT(sizes, ElementsAre(90, 90, 180));
  EXPECT_DOUBLE_EQ(written.value(0, bin(30, 20, 90)), 0.5 * 1500);
  EXPECT_DOUBLE_EQ(written.value(1, bin(30, 20, 90)), 0.25 * 1500 / 1.15);
  EXPECT_EQ(written.value(2, bin(30, 20, 90)), -1);
  EXPECT_DOUBLE_EQ(written.value(2, bin(5, 40, 20)), 3 * 1500 / 1.66);
  std::size_t empty = 0;
  for (std::size_t i = 0; i < bin_count; ++i) empty += written.value(0, i) == -1 ? 1 : 0;
  EXPECT_EQ(empty, bin_count - 2);
  EXPECT_EQ(written.loss.written, 2u);
  EXPECT_EQ(written.loss.filled, 2u);
  EXPECT_EQ(written.loss.moved + written.loss.merged + written.loss.turned, 0u);
  EXPECT_THAT(table::describe(written.loss),
              ElementsAre("2 of the 1458000 bins hold a measurement"));
}

TEST(MerlWriter, SaysWhatIsLost) {
  SampleTable t = table_of_channels({"red", "G", "B"});
  add(t, at_node(30, 20, 90), {1, 1, 1});
  add(t, at_node(30, 20.5, 90), {2, 4, nan});  // shares the bin, half a degree away
  HalfDifference elsewhere = at_node(30, 30, 90);
  elsewhere.phi_h = 1;
  add(t, elsewhere, {-0.25, 1, 1});
  add(t, at_node(30, 40, 90), {nan, nan, nan}, MaskReason::hole);
  add(t, at_node(30, 50, 90), {5, 5, 5}, MaskReason::extrapolated);
  t.weight.assign(5, 1);
  t.sigma.assign(3, std::vector<double>(5, 0.1));
  const Written written = write(t);
  EXPECT_DOUBLE_EQ(written.value(0, bin(30, 20, 90)), 1.5 * 1500);
  EXPECT_DOUBLE_EQ(written.value(1, bin(30, 20, 90)), 2.5 * 1500 / 1.15);
  EXPECT_DOUBLE_EQ(written.value(2, bin(30, 20, 90)), 1500 / 1.66);  // the one that has it
  EXPECT_EQ(written.value(0, bin(30, 30, 90)), 0);
  EXPECT_EQ(written.value(0, bin(30, 40, 90)), -1);
  EXPECT_EQ(written.value(0, bin(30, 50, 90)), -1);
  EXPECT_EQ(written.loss.samples, 5u);
  EXPECT_EQ(written.loss.written, 3u);
  EXPECT_EQ(written.loss.holes, 1u);
  EXPECT_EQ(written.loss.filled, 2u);
  EXPECT_NEAR(written.loss.largest_move_deg, 0.5, 1e-9);
  EXPECT_THAT(
      table::describe(written.loss),
      ElementsAre(HasSubstr("channels red, G, B became R, G and B"),
                  HasSubstr("1 of the 5 samples are masked"),
                  AllOf(HasSubstr("1 of the 5 samples were moved"), HasSubstr("0.5 deg")),
                  HasSubstr("2 samples share their bin"), HasSubstr("1 samples were turned"),
                  HasSubstr("1 negative values became 0"), HasSubstr("2 of the 1458000 bins"),
                  HasSubstr("standard deviations"), HasSubstr("weights")));
}

TEST(MerlWriter, AReadingIsNotMixedWithWhatStandsAtTheHorizon) {
  SampleTable t = table_of_channels({"R", "G", "B"});
  add(t, at_node(30, 20, 90), {9, 9, 9}, MaskReason::horizon);
  add(t, at_node(30, 20, 90), {1, 1, 1});
  add(t, at_node(60, 80, 0), {2, 2, 2}, MaskReason::horizon);    // alone, at its node
  add(t, at_node(60, 81.5, 0), {3, 3, 3}, MaskReason::horizon);  // not at a node
  const Written written = write(t);
  EXPECT_DOUBLE_EQ(written.value(0, bin(30, 20, 90)), 1500);
  EXPECT_DOUBLE_EQ(written.value(0, bin(60, 80, 0)), 3000);
  EXPECT_EQ(written.value(0, bin(60, 81, 0)), -1);
  EXPECT_EQ(written.loss.dropped, 2u);
}

TEST(MerlWriter, WhereWiIsWoTheSamplesOfARowFillItInOrder) {
  SampleTable t = table_of_channels({"R", "G", "B"});
  for (const double f_r : {1.0, 2.0, 3.0}) add(t, at_node(12, 0, 0), {f_r, f_r, f_r});
  const Written written = write(t);
  EXPECT_DOUBLE_EQ(written.value(0, bin(12, 0, 0)), 1500);
  EXPECT_DOUBLE_EQ(written.value(0, bin(12, 0, 2)), 4500);
  EXPECT_EQ(written.value(0, bin(12, 0, 3)), -1);
  EXPECT_EQ(written.loss.merged, 0u);
}

TEST(MerlWriter, RefusesWhatMerlCannotHold) {
  EXPECT_THAT(refusal(table_of_channels({"mean"})),
              AllOf(HasSubstr("scan.csv: 1 channel, expected the three channels"),
                    HasSubstr("--channels")));
  EXPECT_THAT(refusal(table_of_channels({"a", "b", "c", "d"})), HasSubstr("4 channels"));
  SampleTable t = table_of_channels({"R", "G", "B"});
  add(t, at_node(3, 20, 90), {1, 1e306, 1});
  EXPECT_THAT(refusal(t), HasSubstr("scan.csv: channel G: a value is too large"));
}

/// A file whose values are spread over all their digits, a tenth of them holes.
std::string random_file() {
  std::string bytes(file_size, '\0');
  const std::array<std::int32_t, 3> sizes{90, 90, 180};
  std::memcpy(bytes.data(), sizes.data(), sizeof sizes);
  std::mt19937_64 random(7);
  std::vector<double> values(3 * bin_count);
  for (double& value : values) {
    const std::uint64_t bits = random();
    value = bits % 10 == 0 ? -1 : std::ldexp(static_cast<double>(bits >> 11), -45);
  }
  std::memcpy(bytes.data() + sizeof sizes, values.data(), values.size() * sizeof(double));
  return bytes;
}

/// How many samples differ in a value; two holes do not.
std::size_t differences(const SampleTable& a, const SampleTable& b) {
  std::size_t count = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double x = a.values[c][i];
      const double y = b.values[c][i];
      count += x == y || (std::isnan(x) && std::isnan(y)) ? 0 : 1;
    }
  }
  return count;
}

TEST(MerlWriter, AMerlTableReadsBackToTheSameBits) {
  const std::string bytes = random_file();
  SampleTable t = table::read_merl(bytes, "random.binary", {});
  const Written written = write(t);
  EXPECT_THAT(table::describe(written.loss), IsEmpty());
  EXPECT_EQ(differences(t, table::read_merl(written.bytes, "back.binary", {})), 0u);

  // So it does after its directions lost what single precision does not hold.
  for (std::vector<double>* array : {&t.wi.x, &t.wi.y, &t.wi.z, &t.wo.x, &t.wo.y, &t.wo.z}) {
    for (double& component : *array) component = static_cast<double>(static_cast<float>(component));
  }
  const Written again = write(t);
  EXPECT_THAT(table::describe(again.loss), IsEmpty());
  EXPECT_EQ(again.bytes, written.bytes);
}

TEST(MerlWriterData, TheRealFileIsWrittenByteForByte) {
  GONIO_REAL_DATA_OR_SKIP(path, "merl/gold-metallic-paint.nbrdf.binary");
  const table::InputFile file(path);
  const Written written = write(table::read_merl(file.bytes(), path, {}));
  EXPECT_TRUE(written.bytes == file.bytes());
  EXPECT_THAT(table::describe(written.loss), IsEmpty());
  EXPECT_EQ(written.loss.filled, 1'111'432u);  // 346,568 bins hold -1
}

}  // namespace
}  // namespace gonio::tests
