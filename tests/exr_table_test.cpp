// Tables as OpenEXR images: what is written reads back to the same bits.
#include "table/formats/exr_table.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "exr/memory_stream.h"
#include "table/direction_angles.h"
#include "table/file_error.h"
#include "table/formats/exr_table_writer.h"

namespace gonio::tests {
namespace {

using brdf::direction_from_degrees;
using table::MaskReason;
using table::SampleTable;
using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string written(const SampleTable& table, bool exact = true) {
  std::string bytes;
  table::write_exr_table(table, {.exact = exact}, [&](std::string_view piece) { bytes += piece; });
  return bytes;
}

SampleTable read(const std::string& bytes) { return table::read_exr_table(bytes, "t.exr", {}); }

/// Random values on a goniometer's angles, with all that a table can carry.
SampleTable random_table(std::size_t samples, const std::vector<std::string>& channels) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform;
  SampleTable table;
  table.name = "random";
  table.channels = channels;
  table.notes = {"a note", "another one"};
  table.values.resize(channels.size());
  table.sigma.resize(channels.size());
  for (std::size_t i = 0; i < samples; ++i) {
    table.wi.push_back(direction_from_degrees(double(i / 40 % 9) * 10, 200));
    table.wo.push_back(direction_from_degrees(double(i % 40) * 2.25, double(i % 7) * 51.25 - 150));
    for (std::size_t c = 0; c < channels.size(); ++c) {
      table.values[c].push_back(i % 11 == c ? nan : std::exp(20 * uniform(random) - 15));
      table.sigma[c].push_back(i % 11 == c ? nan : 1e-3 + uniform(random));
    }
    table.weight.push_back(uniform(random));
    const bool is_hole = channels.size() == 1 && i % 11 == 0;
    table.mask.push_back(i % 13 == 4 ? MaskReason::retro
                         : is_hole   ? MaskReason::hole
                                     : MaskReason::none);
  }
  return table;
}

void expect_same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))
        << i << ": " << a[i] << ", " << b[i];
  }
}

void expect_same(const SampleTable& a, const SampleTable& b) {
  EXPECT_EQ(a.channels, b.channels);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.notes, b.notes);
  EXPECT_EQ(a.mask, b.mask);
  expect_same_bits(a.weight, b.weight);
  ASSERT_EQ(a.sigma.size(), b.sigma.size());
  for (std::size_t c = 0; c < a.values.size(); ++c) expect_same_bits(a.values[c], b.values[c]);
  for (std::size_t c = 0; c < a.sigma.size(); ++c) expect_same_bits(a.sigma[c], b.sigma[c]);
  for (const auto directions : {&SampleTable::wi, &SampleTable::wo}) {
    expect_same_bits((a.*directions).x, (b.*directions).x);
    expect_same_bits((a.*directions).y, (b.*directions).y);
    expect_same_bits((a.*directions).z, (b.*directions).z);
  }
}

TEST(ExrTable, ReadsBackToTheSameBits) {
  for (const std::size_t samples : {1U, 2U, 39U, 40U, 360U, 1001U}) {
    const SampleTable table = random_table(samples, {"R", "G", "B"});
    expect_same(table, read(written(table)));
  }
}

TEST(ExrTable, KeepsTheOrderAndTheNamesOfChannels) {
  std::vector<std::string> names{"z", "mask", "a.b", "channel2", "550nm", "450 nm", "\xc3\xa4"};
  for (int c = 0; c < 200; ++c) names.push_back(fmt::format("{}", c));
  const SampleTable table = random_table(50, names);
  expect_same(table, read(written(table)));
}

TEST(ExrTable, KeepsNumbersBeyondTheRangeOfFloat) {
  SampleTable table = random_table(40, {"R"});
  table.sigma.clear();
  table.values[0][1] = 1e300;
  table.values[0][2] = -5e-324;
  table.values[0][3] = 1e-42;
  table.values[0][4] = -0.0;
  const SampleTable back = read(written(table));
  expect_same(table, back);
  EXPECT_TRUE(std::signbit(back.values[0][4]));
}

TEST(ExrTable, WithoutTailsNumbersHaveTwentyFourBits) {
  const SampleTable table = random_table(400, {"R"});
  const std::string single = written(table, false);
  EXPECT_LT(single.size(), 0.7 * double(written(table).size()));
  const SampleTable back = read(single);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (std::isnan(table.values[0][i])) continue;
    EXPECT_NEAR(back.values[0][i], table.values[0][i], 6e-8 * table.values[0][i]);
    EXPECT_NEAR(back.wo.x[i], table.wo.x[i], 3e-7);
  }
}

TEST(ExrTable, WithoutTailsNumbersBeyondTheRangeOfFloatStayWhole) {
  SampleTable table = random_table(40, {"R"});
  table.values[0].assign(40, 0.5);
  table.sigma[0].assign(40, 0.25);
  table.values[0][1] = 1e300;
  table.sigma[0][1] = 1e-50;
  const SampleTable back = read(written(table, false));
  expect_same_bits(back.values[0], table.values[0]);
  expect_same_bits(back.sigma[0], table.sigma[0]);
}

TEST(ExrTable, MasksWhatRoundingMovesToTheHorizon) {
  SampleTable table = random_table(3, {"R"});
  table.values[0].assign(3, 0.5);
  table.sigma.clear();
  table.mask.assign(3, MaskReason::none);
  table.wo.set(1, direction_from_degrees(89.999997, 0));
  EXPECT_EQ(read(written(table)).mask, table.mask);
  EXPECT_EQ(read(written(table, false)).mask[1], MaskReason::horizon);
}

TEST(ExrTable, RefusesToWriteATableWithoutSamples) {
  EXPECT_THROW(written(random_table(0, {"R"})), table::FileError);
}

TEST(ExrTable, ExactlyWrittenAnglesNeedNoTail) {
  SampleTable table = random_table(80, {"R"});
  table.sigma.clear();
  table.weight.clear();
  for (std::size_t i = 0; i < table.size(); ++i) {
    table.wo.set(i, direction_from_degrees(double(i % 40) * 2, 90));
    table.values[0][i] = 0.5;
    table.mask[i] = MaskReason::none;
  }
  const std::string bytes = written(table);
  exr::MemoryInput input(bytes);
  Imf::InputFile file(input, 0);
  for (auto channel = file.header().channels().begin(); channel != file.header().channels().end();
       ++channel) {
    EXPECT_EQ(std::string(channel.name()).find('.'), std::string::npos) << channel.name();
  }
}

TEST(ExrTable, ShowsValuesToOrdinaryReaders) {
  const SampleTable table = random_table(80, {"R", "G", "B"});
  const std::string bytes = written(table);
  exr::MemoryInput input(bytes);
  Imf::InputFile file(input, 0);
  // A row per light.
  EXPECT_EQ(file.header().dataWindow().max.x + 1, 40);
  EXPECT_EQ(file.header().dataWindow().max.y + 1, 2);
  std::vector<float> green(80);
  Imf::FrameBuffer buffer;
  buffer.insert("G", Imf::Slice::Make(Imf::FLOAT, green.data(), Imath::V2i(0, 0), 40, 2));
  file.setFrameBuffer(buffer);
  file.readPixels(0, 1);
  for (std::size_t i = 0; i < 80; ++i) {
    const double value = table.values[1][i];
    if (std::isnan(value)) {
      EXPECT_TRUE(std::isnan(green[i]));
    } else {
      EXPECT_NEAR(double{green[i]}, value, 1.2e-7 * value);
    }
  }
}

TEST(DirectionAngles, FindTheAnglesThatWereWritten) {
  for (const double theta : {0.5, 20.0, 33.3, 89.999, 90.0}) {
    for (const double phi : {-150.25, -90.0, 0.0, 45.125, 180.0, 200.0, 359.5}) {
      const auto d = direction_from_degrees(theta, phi);
      const table::AnglesDeg angles = table::angles_of(d);
      EXPECT_EQ(angles.theta, theta) << phi;
      const auto again = direction_from_degrees(angles.theta, angles.phi);
      EXPECT_EQ(again.x, d.x);
      EXPECT_EQ(again.y, d.y);
    }
  }
}

TEST(DirectionAngles, GiveAnyDirectionTo1e15) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const double x = normal(random);
    const double y = normal(random);
    const double z = normal(random);
    const double length = std::sqrt(x * x + y * y + z * z);
    const brdf::Direction<double> d{x / length, y / length, z / length};
    const table::AnglesDeg angles = table::angles_of(d);
    const auto again = direction_from_degrees(angles.theta, angles.phi);
    EXPECT_NEAR(again.x, d.x, 1e-15);
    EXPECT_NEAR(again.y, d.y, 1e-15);
    EXPECT_NEAR(again.z, d.z, 1e-15);
  }
  EXPECT_EQ(table::angles_of({0, 0, 1}).theta, 0);
  EXPECT_EQ(table::angles_of({0, 0, -1}).theta, 180);
}

// Bad files
// ------------------------------------------------------------------------------------------

std::string refusal(const std::string& bytes) {
  try {
    read(bytes);
  } catch (const table::FileError& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "accepted";
}

/// An image with a FLOAT channel R and what `change` makes of its header.
template <class Change>
std::string image(const Change& change) {
  Imf::Header header(4, 4);
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  change(header);
  exr::MemoryOutput stream;
  {
    std::vector<float> pixels(16, 1.0F);
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice::Make(Imf::FLOAT, pixels.data(), Imath::V2i(0, 0), 4, 4));
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(buffer);
    file.writePixels(4);
  }
  return stream.text();
}

TEST(ExrTable, SaysThatAPictureIsNoTable) {
  EXPECT_THAT(refusal(image([](Imf::Header&) {})),
              HasSubstr("attribute gonioSampledBrdf: missing"));
  EXPECT_THAT(refusal(image([](Imf::Header& header) {
                header.insert(table::exr_attribute::version, Imf::IntAttribute(2));
              })),
              HasSubstr("a newer gonio wrote this table"));
  EXPECT_THAT(refusal(image([](Imf::Header& header) {
                header.insert(table::exr_attribute::version, Imf::IntAttribute(1));
                header.insert(table::exr_attribute::samples, Imf::IntAttribute(17));
              })),
              HasSubstr("found 17"));
}

TEST(ExrTable, RefusesWhatIsCutOffAnywhere) {
  const std::string bytes = written(random_table(40, {"R"}));
  for (std::size_t size = 4; size < bytes.size(); size += 7) {
    EXPECT_THAT(refusal(bytes.substr(0, size)), HasSubstr("t.exr: ")) << size;
  }
}

TEST(ExrTable, RefusesAHugeWindowBeforeItIsAllocated) {
  std::string bytes = written(random_table(40, {"R"}));
  const std::size_t window = bytes.find("dataWindow") + 11 + 6 + 4 + 8;
  const std::int32_t huge = 40'000;
  std::memcpy(bytes.data() + window, &huge, 4);
  std::memcpy(bytes.data() + window + 4, &huge, 4);
  EXPECT_THAT(refusal(bytes), HasSubstr("more than a file of"));
}

TEST(ExrTable, RefusesANumberOfAnotherSizeThanItsType) {
  // OpenEXR would take 4 bytes, then the rest of the 10 for the next attribute's name and size.
  std::string bytes = written(random_table(40, {"R"}));
  const std::size_t size = bytes.find("gonioSamples") + 13 + 4;
  const std::int32_t longer = 10;
  std::memcpy(bytes.data() + size, &longer, 4);
  EXPECT_THAT(refusal(bytes), HasSubstr("gonioSamples: found 10 bytes, not the size of a int"));
}

TEST(ExrTable, RefusesAnAttributeLargerThanTheFile) {
  std::string bytes = written(random_table(40, {"R"}));
  const std::size_t size = bytes.find("gonioName") + 10 + 7;
  const std::int32_t huge = 0x7fffffff;
  std::memcpy(bytes.data() + size, &huge, 4);
  EXPECT_THAT(refusal(bytes), HasSubstr("bytes where"));
}

/// A table's bytes with what `change` makes of its header and of the pixels of a channel.
struct Change {
  std::function<void(Imf::Header&)> header = [](Imf::Header&) {};
  std::string channel{};
  std::function<void(std::vector<std::uint32_t>&)> pixels = [](auto&) {};
};

std::string changed(const std::string& bytes, const Change& change) {
  exr::MemoryInput input(bytes);
  Imf::InputFile from(input, 0);
  Imf::Header header = from.header();
  const std::int64_t width = header.dataWindow().max.x + 1;
  const int height = header.dataWindow().max.y + 1;
  Imf::FrameBuffer buffer;
  std::map<std::string, std::vector<std::uint32_t>> pixels;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    auto& plane = pixels[channel.name()];
    plane.resize(static_cast<std::size_t>(width * height));
    buffer.insert(channel.name(), Imf::Slice::Make(channel.channel().type, plane.data(),
                                                   Imath::V2i(0, 0), width, height));
  }
  from.setFrameBuffer(buffer);
  from.readPixels(0, height - 1);
  change.header(header);
  if (!change.channel.empty()) change.pixels(pixels.at(change.channel));
  exr::MemoryOutput stream;
  {
    Imf::OutputFile to(stream, header, 0);
    to.setFrameBuffer(buffer);
    to.writePixels(height);
  }
  return stream.text();
}

TEST(ExrTable, RefusesAttributesThatContradictItsPixels) {
  SampleTable table = random_table(40, {"R"});
  table.notes.clear();
  const std::string bytes = written(table);
  const auto with = [&](const char* attribute, const auto& value) {
    return changed(bytes,
                   {.header = [&](Imf::Header& header) { header.insert(attribute, value); }});
  };
  const auto texts = [](const std::vector<std::string>& list) {
    return Imf::StringVectorAttribute(list);
  };
  EXPECT_EQ(refusal(changed(bytes, {})), "accepted");
  for (const char* taken : {"theta_i", "sigma_R", "weight", "mask"}) {
    EXPECT_THAT(refusal(with(table::exr_attribute::pixel_channels, texts({taken}))),
                HasSubstr(taken));
  }
  EXPECT_THAT(refusal(with(table::exr_attribute::pixel_channels, texts({"R", "R"}))),
              HasSubstr("found 2 names"));
  EXPECT_THAT(refusal(with(table::exr_attribute::axes, texts({"theta_o", "phi_o"}))),
              HasSubstr("expected theta_i, phi_i, theta_o, phi_o"));
  EXPECT_THAT(refusal(with(table::exr_attribute::notes, Imf::IntAttribute(0))),
              HasSubstr("attribute gonioNotes: found the type int"));
  EXPECT_THAT(refusal(with(table::exr_attribute::isotropy, Imf::StringAttribute("no"))),
              HasSubstr("attribute gonioTakesIsotropy: found the type string"));
  EXPECT_FALSE(read(with(table::exr_attribute::isotropy, Imf::IntAttribute(0))).takes_isotropy);
  EXPECT_TRUE(read(with(table::exr_attribute::isotropy, Imf::IntAttribute(1))).takes_isotropy);
}

TEST(ExrTable, RefusesPixelsThatAreNoNumbersOfATable) {
  const std::string bytes = written(random_table(40, {"R"}));
  const auto with = [&](const char* channel, std::uint32_t bits) {
    return refusal(
        changed(bytes, {.channel = channel, .pixels = [&](auto& pixels) { pixels[1] = bits; }}));
  };
  // An infinite head must not become the NaN of a hole by the bits of its tail.
  EXPECT_THAT(with("R", 0x7f800000U), HasSubstr("channel R: found inf"));
  EXPECT_THAT(with("R.tail", 1U << 29), HasSubstr("expected a number below 2^29"));
  EXPECT_THAT(with("mask", 99), HasSubstr("channel mask: found 99"));
  EXPECT_THAT(with("theta_o", 0x7fc00000U), HasSubstr("channel theta_o: found nan"));
}

TEST(ExrTable, RefusesNumbersThatNoTableHas) {
  const auto with = [](const auto& change) {
    SampleTable table = random_table(40, {"R"});
    table.values[0].assign(40, 0.5);
    table.sigma[0].assign(40, 0.25);
    change(table);
    return refusal(written(table));
  };
  EXPECT_EQ(with([](SampleTable&) {}), "accepted");
  EXPECT_THAT(with([](SampleTable& t) { t.sigma[0][3] = 0; }),
              HasSubstr("sample 3, channel sigma_R: found 0"));
  EXPECT_THAT(with([](SampleTable& t) { t.sigma[0][3] = nan; }), HasSubstr("sigma_R: found nan"));
  EXPECT_THAT(with([](SampleTable& t) { t.weight[5] = -1; }),
              HasSubstr("channel weight: found -1"));
  EXPECT_THAT(
      with([](SampleTable& t) { t.values[0][2] = std::numeric_limits<double>::infinity(); }),
      HasSubstr("channel R: found inf"));
  EXPECT_THAT(with([](SampleTable& t) { t.wo.set(7, direction_from_degrees(120, 0)); }),
              HasSubstr("channel theta_o: found 120, expected 0 to 90 deg"));
  EXPECT_EQ(with([](SampleTable& t) {
              t.wo.set(7, direction_from_degrees(120, 0));
              t.mask[7] = MaskReason::horizon;
            }),
            "accepted");
}

}  // namespace
}  // namespace gonio::tests
