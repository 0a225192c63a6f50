#include "table/formats/exr_table.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <type_traits>

#include "exr/attributes.h"
#include "exr/header_check.h"
#include "exr/memory_stream.h"
#include "table/channel_names.h"
#include "table/file_error.h"
#include "table/formats/columns.h"
#include "table/formats/exr_numbers.h"

namespace gonio::table {

namespace {

constexpr std::size_t lines_per_block = 16;
constexpr double horizon_tolerance_deg = 1e-6;

template <class Attribute>
const auto& value_of(const Imf::Header& header, const char* name) {
  return exr::value_of<Attribute>(header, name, "gonio table convert");
}

/// The value of an attribute that may be missing, but not be of another type.
template <class Attribute>
auto optional_value_of(const Imf::Header& header, const char* name) {
  using Value = std::remove_cvref_t<decltype(value_of<Attribute>(header, name))>;
  return header.find(name) == header.end() ? Value{} : value_of<Attribute>(header, name);
}

void require_texts(const Imf::Header& header, const char* name,
                   const std::vector<std::string>& expected) {
  if (value_of<Imf::StringVectorAttribute>(header, name) != expected) {
    throw std::runtime_error(
        fmt::format("attribute {}: expected {}", name, fmt::join(expected, ", ")));
  }
}

struct Size {
  std::size_t width, height, samples;
};

Size size_of(const Imf::Header& header) {
  const int version = value_of<Imf::IntAttribute>(header, exr_attribute::version);
  if (version < 1 || version > exr_table_version) {
    throw std::runtime_error(fmt::format(
        "attribute {}: found {}, expected {}{}", exr_attribute::version, version, exr_table_version,
        version > exr_table_version ? "; a newer gonio wrote this table, which reads it" : ""));
  }
  const int samples = value_of<Imf::IntAttribute>(header, exr_attribute::samples);
  const Imath::Box2i& window = header.dataWindow();
  const Size size{static_cast<std::size_t>(window.max.x) + 1,
                  static_cast<std::size_t>(window.max.y) + 1,
                  static_cast<std::size_t>(std::max(samples, 0))};
  if (samples < 1 || size.samples > size.width * size.height ||
      size.samples <= size.width * (size.height - 1)) {
    throw std::runtime_error(fmt::format(
        "attribute {}: found {}, expected as many as {} x {} pixels hold, with padding in the last "
        "row only",
        exr_attribute::samples, samples, size.width, size.height));
  }
  return size;
}

/// Pixel channels of one number, read a block of lines at a time.
class NumberReader {
 public:
  NumberReader(const Imf::Header& header, std::string channel) : channel_(std::move(channel)) {
    require(header, channel_, Imf::FLOAT);
    const Imf::ChannelList& channels = header.channels();
    is_whole_ = channels.findChannel(channel_ + ".high") != nullptr;
    has_tail_ = !is_whole_ && channels.findChannel(channel_ + ".tail") != nullptr;
    if (is_whole_) {
      require(header, channel_ + ".high", Imf::UINT);
      require(header, channel_ + ".low", Imf::UINT);
    }
    if (has_tail_) require(header, channel_ + ".tail", Imf::UINT);
  }

  const std::string& channel() const { return channel_; }

  void insert(Imf::FrameBuffer& buffer, std::size_t width, std::size_t line, std::size_t lines) {
    const auto slice = [&](const std::string& name, Imf::PixelType type, auto& pixels) {
      pixels.resize(width * lines);
      buffer.insert(name, Imf::Slice::Make(
                              type, pixels.data(), Imath::V2i(0, static_cast<int>(line)),
                              static_cast<std::int64_t>(width), static_cast<std::int64_t>(lines)));
    };
    slice(channel_, Imf::FLOAT, head_);
    if (is_whole_) {
      slice(channel_ + ".high", Imf::UINT, high_);
      slice(channel_ + ".low", Imf::UINT, low_);
    }
    if (has_tail_) slice(channel_ + ".tail", Imf::UINT, low_);
  }

  double at(std::size_t pixel) const {
    if (is_whole_) return whole_of(high_[pixel], low_[pixel]);
    if (!has_tail_) return double{head_[pixel]};
    if (low_[pixel] > tail_mask) {
      throw std::runtime_error(fmt::format(
          "channel {}.tail: found {}, expected a number below 2^29", channel_, low_[pixel]));
    }
    return joined(head_[pixel], low_[pixel]);
  }

  static void require(const Imf::Header& header, const std::string& channel, Imf::PixelType type) {
    const Imf::Channel* found = header.channels().findChannel(channel);
    const std::string_view type_name = type == Imf::FLOAT ? "FLOAT" : "UINT";
    if (found == nullptr) {
      throw std::runtime_error(
          fmt::format("no pixel channel '{}', expected one of type {}", channel, type_name));
    }
    if (found->type != type || found->xSampling != 1 || found->ySampling != 1) {
      throw std::runtime_error(
          fmt::format("pixel channel '{}': expected one of type {}, sampled at every pixel",
                      channel, type_name));
    }
  }

 private:
  std::string channel_;
  bool has_tail_ = false;
  bool is_whole_ = false;
  std::vector<float> head_;
  std::vector<std::uint32_t> high_, low_;
};

/// Everything that a block of lines is read into.
struct Readers {
  std::array<std::unique_ptr<NumberReader>, 4> angles;
  std::vector<NumberReader> values, sigmas;
  std::unique_ptr<NumberReader> weight;
  bool has_mask = false;
  std::vector<std::uint32_t> mask{};
  std::vector<MaskReason> reasons{};  // by code
};

std::vector<MaskReason> reasons_of(const Imf::Header& header) {
  std::vector<MaskReason> reasons;
  for (const std::string& text :
       value_of<Imf::StringVectorAttribute>(header, exr_attribute::mask_reasons)) {
    const auto reason = mask_reason_named(text);
    if (!reason) {
      throw std::runtime_error(
          fmt::format("attribute {}: found '{}', which is no reason that this gonio knows",
                      exr_attribute::mask_reasons, text));
    }
    reasons.push_back(*reason);
  }
  return reasons;
}

Readers readers_of(const Imf::Header& header) {
  Readers readers;
  for (std::size_t a = 0; a < readers.angles.size(); ++a) {
    readers.angles[a] = std::make_unique<NumberReader>(header, angle_names[a]);
  }
  const auto pixels = value_of<Imf::StringVectorAttribute>(header, exr_attribute::pixel_channels);
  const bool has_sigma =
      !pixels.empty() && header.channels().findChannel("sigma_" + pixels.front()) != nullptr;
  for (const std::string& pixel : pixels) {
    readers.values.emplace_back(header, pixel);
    if (has_sigma) readers.sigmas.emplace_back(header, "sigma_" + pixel);
  }
  if (header.channels().findChannel("weight") != nullptr) {
    readers.weight = std::make_unique<NumberReader>(header, "weight");
  }
  readers.has_mask = header.channels().findChannel("mask") != nullptr;
  if (readers.has_mask) {
    NumberReader::require(header, "mask", Imf::UINT);
    readers.reasons = reasons_of(header);
  }
  return readers;
}

template <class F>
void for_each_number(Readers& readers, const F& f) {
  for (auto& angle : readers.angles) f(*angle);
  for (NumberReader& value : readers.values) f(value);
  for (NumberReader& sigma : readers.sigmas) f(sigma);
  if (readers.weight) f(*readers.weight);
}

void read_block(Imf::InputFile& file, Readers& readers, std::size_t width, std::size_t line,
                std::size_t lines) {
  Imf::FrameBuffer buffer;
  for_each_number(readers,
                  [&](NumberReader& reader) { reader.insert(buffer, width, line, lines); });
  if (readers.has_mask) {
    readers.mask.resize(width * lines);
    buffer.insert("mask", Imf::Slice::Make(
                              Imf::UINT, readers.mask.data(), Imath::V2i(0, static_cast<int>(line)),
                              static_cast<std::int64_t>(width), static_cast<std::int64_t>(lines)));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(static_cast<int>(line), static_cast<int>(line + lines - 1));
}

[[noreturn]] void refuse(std::size_t sample, const std::string& channel, double found,
                         std::string_view expected) {
  throw std::runtime_error(fmt::format("sample {}, channel {}: found {}, expected {}", sample,
                                       channel, found, expected));
}

MaskReason reason_at(const Readers& readers, std::size_t pixel, std::size_t sample) {
  if (!readers.has_mask) return MaskReason::none;
  const std::uint32_t code = readers.mask[pixel];
  if (code < readers.reasons.size()) return readers.reasons[code];
  refuse(sample, "mask", code, "the code of a reason");
}

double checked_angle(const NumberReader& reader, std::size_t pixel, std::size_t sample,
                     bool is_polar, bool is_horizon) {
  const double angle = reader.at(pixel);
  // Only what is masked as horizon may lie below it.
  const double most = is_horizon ? 180 + horizon_tolerance_deg : 90 + horizon_tolerance_deg;
  if (std::isfinite(angle) && (!is_polar || (angle >= 0 && angle <= most))) return angle;
  refuse(sample, reader.channel(), angle, is_polar ? "0 to 90 deg" : "a finite azimuth");
}

void write_sample(const Readers& readers, std::size_t pixel, std::size_t i, SampleTable& table) {
  const MaskReason written = reason_at(readers, pixel, i);
  const bool is_horizon = written == MaskReason::horizon;
  const auto angle = [&](Angle a) {
    return checked_angle(*readers.angles[a], pixel, i, a == theta_i || a == theta_o, is_horizon);
  };
  table.wi.set(i, brdf::direction_from_degrees(angle(theta_i), angle(phi_i)));
  table.wo.set(i, brdf::direction_from_degrees(angle(theta_o), angle(phi_o)));
  // Rounding to 24 bits may have moved a direction there.
  const bool is_horizontal = std::max(angle(theta_i), angle(theta_o)) >= 90 - horizon_tolerance_deg;
  table.mask[i] = written == MaskReason::none && is_horizontal ? MaskReason::horizon : written;
  bool is_hole = true;
  for (std::size_t c = 0; c < readers.values.size(); ++c) {
    const double value = readers.values[c].at(pixel);
    if (std::isinf(value)) refuse(i, readers.values[c].channel(), value, "a finite number");
    table.values[c][i] = value;
    is_hole = is_hole && std::isnan(value);
  }
  for (std::size_t c = 0; c < readers.sigmas.size(); ++c) {
    const double sigma = readers.sigmas[c].at(pixel);
    const bool is_needed = !std::isnan(table.values[c][i]);
    const bool is_fine = std::isnan(sigma) ? !is_needed : sigma > 0 && std::isfinite(sigma);
    if (!is_fine) {
      refuse(i, readers.sigmas[c].channel(), sigma, "a standard deviation above 0");
    }
    table.sigma[c][i] = sigma;
  }
  if (readers.weight) {
    const double weight = readers.weight->at(pixel);
    if (!(std::isfinite(weight) && weight >= 0)) {
      refuse(i, "weight", weight, "a finite number of at least 0");
    }
    table.weight[i] = weight;
  }
  if (is_hole && table.mask[i] == MaskReason::none) table.mask[i] = MaskReason::hole;
}

void resize(SampleTable& table, const Readers& readers, std::size_t samples) {
  table.wi.resize(samples);
  table.wo.resize(samples);
  table.values.assign(readers.values.size(), std::vector<double>(samples));
  table.sigma.assign(readers.sigmas.size(), std::vector<double>(samples));
  if (readers.weight) table.weight.resize(samples);
  table.mask.resize(samples);
}

void read_attributes(const Imf::Header& header, SampleTable& table) {
  table.channels = value_of<Imf::StringVectorAttribute>(header, exr_attribute::channels);
  if (const auto problem = channel_names_problem(table.channels))
    throw std::runtime_error(*problem);
  const auto pixels = value_of<Imf::StringVectorAttribute>(header, exr_attribute::pixel_channels);
  if (pixels.size() != table.channels.size()) {
    throw std::runtime_error(
        fmt::format("attribute {}: found {} names, expected one for each of "
                    "{} channels",
                    exr_attribute::pixel_channels, pixels.size(), table.channels.size()));
  }
  // Else two numbers would be read from one pixel channel.
  if (const auto problem = channel_names_problem(pixels)) {
    throw std::runtime_error(
        fmt::format("attribute {}: {}", exr_attribute::pixel_channels, *problem));
  }
  const auto& quantity = value_of<Imf::StringAttribute>(header, exr_attribute::quantity);
  if (quantity != "brdf") {
    throw std::runtime_error(
        fmt::format("attribute {}: found '{}', expected brdf", exr_attribute::quantity, quantity));
  }
  require_texts(header, exr_attribute::units, {"1/sr", "deg"});
  require_texts(header, exr_attribute::axes, {angle_names.begin(), angle_names.end()});
  table.name = optional_value_of<Imf::StringAttribute>(header, exr_attribute::name);
  table.weight_is_solid_angle =
      optional_value_of<Imf::IntAttribute>(header, exr_attribute::solid_angle) != 0;
  table.takes_isotropy = optional_value_of<Imf::IntAttribute>(header, exr_attribute::isotropy) != 0;
  table.notes = optional_value_of<Imf::StringVectorAttribute>(header, exr_attribute::notes);
}

SampleTable read_table(std::string_view content) {
  exr::check_scan_line_file(content);
  exr::MemoryInput stream(content);
  Imf::InputFile file(stream, 0);
  const Imf::Header& header = file.header();
  const Size size = size_of(header);
  SampleTable table;
  read_attributes(header, table);
  Readers readers = readers_of(header);
  resize(table, readers, size.samples);
  for (std::size_t line = 0; line < size.height; line += lines_per_block) {
    const std::size_t lines = std::min(lines_per_block, size.height - line);
    read_block(file, readers, size.width, line, lines);
    const std::size_t first = line * size.width;
    const std::size_t end = std::min((line + lines) * size.width, size.samples);
    for (std::size_t i = first; i < end; ++i) write_sample(readers, i - first, i, table);
  }
  return table;
}

}  // namespace

bool is_exr_table(std::string_view content) {
  return content.starts_with(std::string_view("\x76\x2f\x31\x01", 4));
}

SampleTable read_exr_table(std::string_view content, const std::string& path,
                           const ReadOptions& /*options*/) {
  try {
    SampleTable table = read_table(content);
    table.provenance = {.path = path,
                        .format = "gonio-table EXR 1",
                        .sha256 = {},
                        .quantity = Quantity::brdf,
                        .angles = AngleUnit::degrees};
    return table;
  } catch (const std::exception& e) {
    // OpenEXR's messages may have several lines.
    std::string problem = e.what();
    std::replace(problem.begin(), problem.end(), '\n', ' ');
    throw FileError(
        fmt::format("{}: an EXR image that is no table of gonio: {}: name one that `gonio table "
                    "convert` wrote",
                    path, problem));
  }
}

}  // namespace gonio::table
