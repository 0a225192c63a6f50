// Tables as EXR files: what is written is read back to the last bit, and what is no table, or not
// one of ours, is refused with the place.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "lut/table_exr.h"
#include "tests/run_gonio.h"

namespace gonio::lut {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refusal(std::string_view bytes) {
  try {
    table_from_exr(bytes);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

void expect_same(const Table& a, const Table& b) {
  EXPECT_EQ(a.layout.kind, b.layout.kind);
  EXPECT_EQ(a.layout.coordinate, b.layout.coordinate);
  EXPECT_EQ(a.layout.storage, b.layout.storage);
  EXPECT_EQ(a.layout.reach, b.layout.reach);
  EXPECT_EQ(a.layout.width, b.layout.width);
  EXPECT_EQ(a.layout.height, b.layout.height);
  EXPECT_EQ(a.layout.lowest, b.layout.lowest);
  EXPECT_EQ(a.layout.highest, b.layout.highest);
  EXPECT_EQ(a.layout.of_cosine, b.layout.of_cosine);
  EXPECT_EQ(a.layout.transparency, b.layout.transparency);
  EXPECT_EQ(a.texture.channels, b.texture.channels);
  for (std::size_t c = 0; c < most_channels; ++c) {
    EXPECT_EQ(a.decoding[c].scale, b.decoding[c].scale);
  }
  ASSERT_EQ(a.texture.texels.size(), b.texture.texels.size());
  EXPECT_EQ(std::memcmp(a.texture.texels.data(), b.texture.texels.data(),
                        a.texture.texels.size() * sizeof(float)),
            0);
}

TEST(LutExr, EveryTableReadsBackToTheLastBit) {
  for (const Storage storage : all_storages) {
    Layout ward{.coordinate = Coordinate::sqrt, .storage = storage, .lowest = 0.05, .highest = 0.1};
    ward.reach = lobe_reach(ward);
    Layout lobe = ward;
    lobe.kind = TableKind::ward_lobe;
    lobe.height = 16;
    const Layout narrow{.storage = storage, .lowest = 1e-4, .highest = 1e-4};
    const Layout power{.kind = TableKind::blinn_phong_power,
                       .coordinate = Coordinate::fourth_root,
                       .width = 100,
                       .height = 20,
                       .storage = storage,
                       .lowest = 1.0 / 3,
                       .highest = 1e6};
    const Layout j{.kind = TableKind::strauss_j,
                   .width = 33,
                   .height = 17,
                   .storage = storage,
                   .of_cosine = true};
    const Layout terms{.kind = TableKind::strauss_terms,
                       .width = 17,
                       .height = 33,
                       .storage = storage,
                       .transparency = 0.1};
    for (const Layout& layout : {ward, narrow, lobe, power, j, terms}) {
      SCOPED_TRACE(name_of(layout.kind));
      const Table table = bake(layout);
      const std::string bytes = exr_of(table);
      expect_same(table_from_exr(bytes), table);
      EXPECT_EQ(exr_of(table), bytes);
    }
  }
  const Table listing = bake({.coordinate = Coordinate::listing});
  expect_same(table_from_exr(exr_of(listing)), listing);
}

/// The bytes of a file of 16 texels of R, all `value`, whose header another program has changed.
template <class Change>
std::string changed_file(const Change& change, float value = 0) {
  const tests::TemporaryFolder folder;
  const std::string good =
      folder.write("good.exr", exr_of(bake({.width = 16, .lowest = 0.1, .highest = 0.1})));
  Imf::Header header = Imf::InputFile(good.c_str(), 0).header();
  change(header);
  const std::string path = folder / "changed.exr";
  {
    Imf::OutputFile file(path.c_str(), header, 0);
    // A row more: a window may begin at x = -1.
    constexpr std::size_t width = 16;
    std::vector<float> pixels(17 * width, value);
    Imf::FrameBuffer buffer;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      buffer.insert(c.name(),
                    Imf::Slice(c.channel().type, reinterpret_cast<char*>(pixels.data() + width), 4,
                               4 * width));
    }
    file.setFrameBuffer(buffer);
    file.writePixels(header.dataWindow().max.y + 1);
  }
  return tests::content_of(path);
}

std::string text_replaced(const char* attribute, const std::string& text) {
  return refusal(changed_file(
      [&](Imf::Header& header) { header.insert(attribute, Imf::StringAttribute(text)); }));
}

TEST(LutExr, AnUnchangedHeaderIsAccepted) {
  EXPECT_EQ(refusal(changed_file([](Imf::Header&) {})), "");
}

/// The header but for an attribute. (Imf::Header::erase() leaks the attribute in OpenEXR 3.1.)
Imf::Header without(const Imf::Header& header, const std::string& name) {
  Imf::Header rest;
  for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
    if (attribute.name() != name) rest.insert(attribute.name(), attribute.attribute());
  }
  return rest;
}

TEST(LutExr, AMissingAttributeIsNamed) {
  for (const char* name : {"gonioVersion", "gonioTable", "gonioCoordinate", "gonioStorage",
                           "gonioReach", "gonioLowest", "gonioHighest", "gonioScale"}) {
    const std::string problem =
        refusal(changed_file([&](Imf::Header& header) { header = without(header, name); }));
    EXPECT_THAT(problem, AllOf(HasSubstr(name), HasSubstr("missing"))) << name;
  }
}

TEST(LutExr, OddAttributesAreRefusedWithWhatWasExpected) {
  EXPECT_THAT(text_replaced("gonioTable", "teapot"),
              AllOf(HasSubstr("gonioTable"), HasSubstr("'teapot'"), HasSubstr("ward-exponent")));
  EXPECT_THAT(text_replaced("gonioCoordinate", "angle"), HasSubstr("fourth-root"));
  EXPECT_THAT(text_replaced("gonioStorage", "r64f"), HasSubstr("unorm16"));
  // Of another type in the file, which has FLOAT.
  EXPECT_THAT(text_replaced("gonioStorage", "r16f"),
              AllOf(HasSubstr("R FLOAT"), HasSubstr("R HALF")));
  EXPECT_THAT(refusal(changed_file([](Imf::Header& header) {
                header = without(header, "gonioReach");
                header.insert("gonioReach", Imf::StringAttribute("1"));
              })),
              AllOf(HasSubstr("gonioReach"), HasSubstr("string"), HasSubstr("double")));
  EXPECT_THAT(
      refusal(changed_file([](Imf::Header& header) {
        header.insert("gonioScale", Imf::V2fAttribute({2, 1}));
      })),
      AllOf(HasSubstr("gonioScale"), HasSubstr("found (2, 1)"), HasSubstr("expected (1, 1)")));
  // Two channels are of the strauss tables.
  EXPECT_THAT(refusal(changed_file([](Imf::Header& header) {
                header.channels().insert("G", Imf::Channel(Imf::FLOAT));
              })),
              AllOf(HasSubstr("G FLOAT, R FLOAT"), HasSubstr("expected R FLOAT")));
}

TEST(LutExr, ANewerVersionIsRefused) {
  const std::string bytes = changed_file(
      [](Imf::Header& header) { header.insert("gonioVersion", Imf::IntAttribute(2)); });
  EXPECT_THAT(refusal(bytes), AllOf(HasSubstr("found 2, expected 1"), HasSubstr("newer")));
}

TEST(LutExr, ASizeThatTheTableCannotHaveIsRefused) {
  const auto with_window = [](Imath::Box2i window) {
    return refusal(changed_file([&](Imf::Header& header) { header.dataWindow() = window; }));
  };
  EXPECT_THAT(with_window({{0, 0}, {15, 15}}), HasSubstr("height of 16"));
  EXPECT_THAT(with_window({{0, 0}, {7, 0}}), HasSubstr("width of 8"));
  EXPECT_THAT(with_window({{-1, 0}, {14, 0}}), HasSubstr("(-1, 0)"));
}

TEST(LutExr, ATexelThatIsNoNumberIsRefusedWithItsPlace) {
  const std::string problem =
      refusal(changed_file([](Imf::Header&) {}, std::numeric_limits<float>::quiet_NaN()));
  EXPECT_THAT(problem, AllOf(HasSubstr("channel R, texel (0, 0)"), HasSubstr("nan")));
}

// An ordinary loader gives the shader's texture 0..1, as the storage does.
TEST(LutExr, IntegersAreWrittenAsTheFloatsTheyStandFor) {
  const tests::TemporaryFolder folder;
  for (const Storage storage : {Storage::unorm16, Storage::unorm8}) {
    const Table table = bake({.kind = TableKind::ward_lobe,
                              .coordinate = Coordinate::sqrt,
                              .width = 64,
                              .storage = storage,
                              .lowest = 1,
                              .highest = 1});
    const std::string path = folder.write("t.exr", exr_of(table));
    Imf::InputFile file(path.c_str(), 0);
    const Imf::Channel* red = file.header().channels().findChannel("R");
    ASSERT_NE(red, nullptr);
    EXPECT_EQ(red->type, Imf::FLOAT);
    std::vector<float> pixels(64);
    Imf::FrameBuffer buffer;
    buffer.insert("R", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels.data()), 4, 256));
    file.setFrameBuffer(buffer);
    file.readPixels(0, 0);
    EXPECT_EQ(pixels, table.texture.texels);
    EXPECT_EQ(pixels.front(), 1) << "the peak";
  }
}

TEST(LutExr, ATexelThatTheIntegersDoNotHoldIsRefused) {
  const auto of = [](const char* storage, float value) {
    // For alpha = 0.1 the integers cover -16 alpha^2 .. 0.
    const auto change = [&](Imf::Header& header) {
      header.insert("gonioStorage", Imf::StringAttribute(storage));
      header.insert("gonioScale", Imf::V2fAttribute({static_cast<float>(-16 * 0.1 * 0.1), 1}));
    };
    return refusal(changed_file(change, value));
  };
  EXPECT_EQ(of("unorm8", 51.0F / 255), "");
  EXPECT_EQ(of("unorm16", 13107.0F / 65535), "") << "the same fifth";
  EXPECT_THAT(of("unorm8", 0.3F), AllOf(HasSubstr("found 0.3"), HasSubstr("1/255 from 0 to 1")));
  EXPECT_THAT(of("unorm16", 0.3F), HasSubstr("1/65535 from 0 to 1"));
  EXPECT_THAT(of("unorm16", 2), HasSubstr("found 2,"));
  EXPECT_THAT(of("unorm8", -1), HasSubstr("found -1,"));
}

TEST(LutExr, WhatIsNoExrOrEndsEarlyIsRefusedInOneLine) {
  const std::string whole = exr_of(bake({.width = 64}));
  for (const std::string& bytes : {std::string(), std::string("P6 3 3 255"), whole.substr(0, 200),
                                   whole.substr(0, whole.size() - 20)}) {
    const std::string problem = refusal(bytes);
    EXPECT_THAT(problem, HasSubstr("no look-up table of gonio"));
    EXPECT_EQ(problem.find('\n'), std::string::npos) << problem;
  }
}

}  // namespace
}  // namespace gonio::lut
