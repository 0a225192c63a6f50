// OpenEXR's documentation: "Reading and Writing Image Files with the OpenEXR Library". Its threads
// are not used.
#include "lut/table_exr.h"

#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "exr/attributes.h"
#include "exr/memory_stream.h"
#include "lut/table_text.h"

namespace gonio::lut {
namespace {

constexpr int version = 1;
constexpr std::array<const char*, most_channels> channel_names{"R", "G"};

constexpr const char* table_attribute = "gonioTable";
constexpr const char* coordinate_attribute = "gonioCoordinate";
constexpr const char* storage_attribute = "gonioStorage";
constexpr const char* version_attribute = "gonioVersion";
constexpr const char* reach_attribute = "gonioReach";
constexpr const char* lowest_attribute = "gonioLowest";
constexpr const char* highest_attribute = "gonioHighest";
constexpr const char* argument_attribute = "gonioArgument";
constexpr const char* transparency_attribute = "gonioTransparency";
constexpr const char* scale_attribute = "gonioScale";

/// Integers are written as the 0..1 that they stand for: UINT is for identifiers, and what loads it
/// makes of the codes what it likes.
Imf::PixelType pixel_type(Storage storage) {
  return storage == Storage::r16f ? Imf::HALF : Imf::FLOAT;
}

std::string_view name_of(Imf::PixelType type) {
  switch (type) {
    case Imf::FLOAT:
      return "FLOAT";
    case Imf::HALF:
      return "HALF";
    default:
      return "UINT";
  }
}

void write_attributes(const Table& table, Imf::Header& header) {
  const Layout& layout = table.layout;
  const auto text = [](std::string_view value) { return Imf::StringAttribute(std::string(value)); };
  header.insert(version_attribute, Imf::IntAttribute(version));
  header.insert(table_attribute, text(lut::name_of(layout.kind)));
  header.insert(coordinate_attribute, text(lut::name_of(layout.coordinate)));
  header.insert(storage_attribute, text(lut::name_of(layout.storage)));
  header.insert(reach_attribute, Imf::DoubleAttribute(layout.reach));
  if (is_strauss(layout.kind)) {
    header.insert(argument_attribute, text(layout.of_cosine ? "cosine" : "angle"));
    header.insert(transparency_attribute, Imf::DoubleAttribute(layout.transparency));
  } else {
    header.insert(lowest_attribute, Imf::DoubleAttribute(layout.lowest));
    header.insert(highest_attribute, Imf::DoubleAttribute(layout.highest));
  }
  const auto& [first, second] = table.decoding;
  header.insert(scale_attribute, Imf::V2fAttribute({first.scale, second.scale}));
  Imf::addComments(header, sampling_text(layout));
}

/// The slices of pixels in the order of a texture's texels.
template <class Pixel>
Imf::FrameBuffer frame_buffer(std::vector<Pixel>& pixels, const Texture& texture) {
  const auto channels = static_cast<std::size_t>(texture.channels);
  const std::size_t step = channels * sizeof(Pixel);
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < channels; ++c) {
    buffer.insert(channel_names[c], Imf::Slice(pixel_type(texture.storage),
                                               reinterpret_cast<char*>(pixels.data() + c), step,
                                               step * static_cast<std::size_t>(texture.width)));
  }
  return buffer;
}

template <class Pixel>
void write_pixels(Imf::OutputFile& file, const Texture& texture) {
  std::vector<Pixel> pixels(texture.texels.begin(), texture.texels.end());
  file.setFrameBuffer(frame_buffer(pixels, texture));
  file.writePixels(texture.height);
}

template <class Pixel>
void read_pixels(Imf::InputFile& file, Texture& texture) {
  std::vector<Pixel> pixels(static_cast<std::size_t>(texture.width) *
                            static_cast<std::size_t>(texture.height) *
                            static_cast<std::size_t>(texture.channels));
  file.setFrameBuffer(frame_buffer(pixels, texture));
  file.readPixels(0, texture.height - 1);
  texture.texels.assign(pixels.begin(), pixels.end());
}

void write_texels(Imf::OutputFile& file, const Texture& texture) {
  if (pixel_type(texture.storage) == Imf::HALF) return write_pixels<half>(file, texture);
  write_pixels<float>(file, texture);
}

void read_texels(Imf::InputFile& file, Texture& texture) {
  if (pixel_type(texture.storage) == Imf::HALF) return read_pixels<half>(file, texture);
  read_pixels<float>(file, texture);
}

std::string_view numbers_of(Storage storage) {
  switch (storage) {
    case Storage::r32f:
    case Storage::r16f:
      break;
    case Storage::unorm16:
      return "a multiple of 1/65535 from 0 to 1, which unorm16 holds";
    case Storage::unorm8:
      return "a multiple of 1/255 from 0 to 1, which unorm8 holds";
  }
  return "a finite number";
}

/// Throws for what no bake stores.
void check_texels(const Texture& texture) {
  for (std::size_t i = 0; i < texture.texels.size(); ++i) {
    const float texel = texture.texels[i];
    // Not equal for one that is infinite or no number, whatever the storage.
    if (stored(static_cast<double>(texel), texture.storage) == texel) continue;
    const auto channels = static_cast<std::size_t>(texture.channels);
    const auto width = static_cast<std::size_t>(texture.width);
    throw std::runtime_error(fmt::format("channel {}, texel ({}, {}): found {}, expected {}",
                                         channel_names[i % channels], i / channels % width,
                                         i / channels / width, texel, numbers_of(texture.storage)));
  }
}

/// The value of an attribute that has to be there and of the type.
template <class Attribute>
const auto& value_of(const Imf::Header& header, const char* name) {
  return exr::value_of<Attribute>(header, name, "gonio lut bake");
}

/// The thing that the attribute's text names.
template <class Named>
auto thing_named(const Imf::Header& header, const char* name, const Named& named) {
  try {
    return named(value_of<Imf::StringAttribute>(header, name));
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(fmt::format("attribute {}: {}", name, e.what()));
  }
}

void check_version(const Imf::Header& header) {
  const int found = value_of<Imf::IntAttribute>(header, version_attribute);
  if (found >= 1 && found <= version) return;
  throw std::runtime_error(
      fmt::format("attribute {}: found {}, expected {}{}", version_attribute, found, version,
                  found > version ? "; a newer gonio wrote this table, which reads it" : ""));
}

bool is_of_cosine(const Imf::Header& header) {
  const std::string& argument = value_of<Imf::StringAttribute>(header, argument_attribute);
  if (argument == "cosine" || argument == "angle") return argument == "cosine";
  throw std::runtime_error(fmt::format("attribute {}: found '{}', expected angle or cosine",
                                       argument_attribute, argument));
}

Layout layout_of(const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  if (window.min.x != 0 || window.min.y != 0) {
    throw std::runtime_error(fmt::format("data window: found one from ({}, {}), expected (0, 0)",
                                         window.min.x, window.min.y));
  }
  Layout layout;
  layout.kind = thing_named(header, table_attribute, table_kind_named);
  layout.coordinate = thing_named(header, coordinate_attribute, coordinate_named);
  layout.storage = thing_named(header, storage_attribute, storage_named);
  layout.reach = value_of<Imf::DoubleAttribute>(header, reach_attribute);
  layout.width = window.max.x + 1;
  layout.height = window.max.y + 1;
  if (is_strauss(layout.kind)) {
    layout.of_cosine = is_of_cosine(header);
    layout.transparency = value_of<Imf::DoubleAttribute>(header, transparency_attribute);
  } else {
    layout.lowest = value_of<Imf::DoubleAttribute>(header, lowest_attribute);
    layout.highest = value_of<Imf::DoubleAttribute>(header, highest_attribute);
  }
  check(layout);
  return layout;
}

void check_decoding(const Imf::Header& header,
                    const std::array<Decoding, most_channels>& expected) {
  const auto& scale = value_of<Imf::V2fAttribute>(header, scale_attribute);
  const auto& [first, second] = expected;
  if (scale == Imath::V2f(first.scale, second.scale)) return;
  throw std::runtime_error(
      fmt::format("attribute {}: found ({}, {}), expected ({}, {}) of this table and storage",
                  scale_attribute, scale.x, scale.y, first.scale, second.scale));
}

void check_channels(const Imf::Header& header, const Texture& texture) {
  std::string found;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    found += fmt::format("{}{} {}", found.empty() ? "" : ", ", c.name(), name_of(c.channel().type));
  }
  // The file has them in the order of the alphabet.
  std::string expected;
  for (int c = texture.channels - 1; c >= 0; --c) {
    expected += fmt::format("{}{} {}", expected.empty() ? "" : ", ",
                            channel_names[static_cast<std::size_t>(c)],
                            name_of(pixel_type(texture.storage)));
  }
  if (found == expected) return;
  throw std::runtime_error(fmt::format("channels: found {}, expected {}", found, expected));
}

Table read_table(Imf::InputFile& file) {
  const Imf::Header& header = file.header();
  check_version(header);
  Table table;
  table.layout = layout_of(header);
  table.decoding = decoding_of(table.layout);
  table.texture = {.width = table.layout.width,
                   .height = table.layout.height,
                   .channels = channels_of(table.layout.kind),
                   .storage = table.layout.storage,
                   .texels = {}};
  check_channels(header, table.texture);
  check_decoding(header, table.decoding);
  read_texels(file, table.texture);
  check_texels(table.texture);
  return table;
}

}  // namespace

std::string exr_of(const Table& table) {
  const Texture& texture = table.texture;
  Imf::Header header(texture.width, texture.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  write_attributes(table, header);
  for (int c = 0; c < texture.channels; ++c) {
    header.channels().insert(channel_names[static_cast<std::size_t>(c)],
                             Imf::Channel(pixel_type(texture.storage)));
  }
  exr::MemoryOutput stream;
  {
    // Its end writes the table of the scan lines.
    Imf::OutputFile file(stream, header, 0);
    write_texels(file, texture);
  }
  return stream.text();
}

Table table_from_exr(std::string_view bytes) {
  try {
    exr::MemoryInput stream(bytes);
    Imf::InputFile file(stream, 0);
    return read_table(file);
  } catch (const std::exception& e) {
    // OpenEXR's messages may have several lines.
    std::string problem = e.what();
    std::replace(problem.begin(), problem.end(), '\n', ' ');
    throw std::runtime_error(fmt::format("no look-up table of gonio: {}", problem));
  }
}

}  // namespace gonio::lut
