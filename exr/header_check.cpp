#include "exr/header_check.h"

#include <fmt/core.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace gonio::exr {
namespace {

constexpr std::uint64_t most_expansion = 1040;

[[noreturn]] void fail(const std::string& problem) { throw std::runtime_error(problem); }

/// Walks over little-endian bytes.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_(bytes) {}

  std::string_view take(std::size_t count) {
    if (count > rest_.size()) fail("the header is cut off");
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  std::int32_t whole_number() {
    std::int32_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  /// A size, which must lie within the bytes.
  std::string_view counted() {
    const std::int32_t size = whole_number();
    if (size < 0 || static_cast<std::size_t>(size) > rest_.size()) {
      fail(fmt::format("the header declares {} bytes where {} are left", size, rest_.size()));
    }
    return take(static_cast<std::size_t>(size));
  }
  std::string_view name() {
    constexpr std::size_t longest = 255;
    const std::size_t end = rest_.substr(0, longest + 1).find('\0');
    if (end == std::string_view::npos) fail("a name in the header has no end");
    const std::string_view text = take(end);
    take(1);
    return text;
  }
  bool is_at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

/// What the pixels need.
struct Pixels {
  std::optional<std::uint64_t> count;
  std::optional<std::uint64_t> bytes_each;
};

std::uint64_t pixel_count(Cursor window) {
  const std::int32_t min_x = window.whole_number();
  const std::int32_t min_y = window.whole_number();
  const std::int32_t max_x = window.whole_number();
  const std::int32_t max_y = window.whole_number();
  if (min_x != 0 || min_y != 0 || max_x < 0 || max_y < 0 || max_x == INT32_MAX ||
      max_y == INT32_MAX) {
    fail(fmt::format("data window: found ({}, {}) to ({}, {}), expected one from (0, 0)", min_x,
                     min_y, max_x, max_y));
  }
  return (static_cast<std::uint64_t>(max_x) + 1) * (static_cast<std::uint64_t>(max_y) + 1);
}

std::uint64_t bytes_per_pixel(Cursor channels) {
  std::uint64_t bytes = 0;
  while (!channels.name().empty()) {
    constexpr std::int32_t half = 1;
    const std::int32_t type = channels.whole_number();
    channels.take(4);  // whether the values are linear
    if (channels.whole_number() != 1 || channels.whole_number() != 1) {
      fail("a channel is not sampled at every pixel");
    }
    bytes += type == half ? 2 : 4;
  }
  if (!channels.is_at_end()) fail("the list of channels goes on behind its end");
  return bytes;
}

void check_strings(Cursor list) {
  while (!list.is_at_end()) list.counted();
}

void check_preview(Cursor preview) {
  const auto width = static_cast<std::uint32_t>(preview.whole_number());
  const auto height = static_cast<std::uint32_t>(preview.whole_number());
  const std::uint64_t bytes = std::uint64_t{width} * height * 4;
  if (width > 65536 || height > 65536) fail("the preview is too large");
  preview.take(static_cast<std::size_t>(bytes));
  if (!preview.is_at_end()) fail("the preview goes on behind its end");
}

void check_compression(Cursor value) {
  constexpr char zip = 3;
  const char compression = value.take(1).front();
  if (compression < 0 || compression > zip) {
    fail("compression: expected none, RLE, ZIPS or ZIP");
  }
}

/// The bytes of the types that always have as many: OpenEXR takes these, whatever the header says,
/// and would read on in the middle of something else. Nothing for other types.
std::optional<std::size_t> fixed_size(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, std::size_t>, 24> sizes{
      {{"int", 4},         {"float", 4},     {"double", 8},   {"box2i", 16},
       {"box2f", 16},      {"v2i", 8},       {"v2f", 8},      {"v2d", 16},
       {"v3i", 12},        {"v3f", 12},      {"v3d", 24},     {"m33f", 36},
       {"m33d", 72},       {"m44f", 64},     {"m44d", 128},   {"chromaticities", 32},
       {"compression", 1}, {"lineOrder", 1}, {"envmap", 1},   {"keycode", 28},
       {"rational", 8},    {"timecode", 8},  {"tiledesc", 9}, {"deepImageState", 1}}};
  for (const auto& [name, size] : sizes) {
    if (name == type) return size;
  }
  return std::nullopt;
}

void check_size(std::string_view name, std::string_view type, std::string_view value) {
  const auto expected = fixed_size(type);
  const bool is_vector = type == "floatvector";
  if (expected ? value.size() == *expected : !is_vector || value.size() % 4 == 0) return;
  fail(fmt::format("attribute {}: found {} bytes, not the size of a {}", name, value.size(), type));
}

void check_attribute(std::string_view name, std::string_view type, std::string_view value,
                     Pixels& pixels) {
  check_size(name, type, value);
  if (name == "dataWindow" && type == "box2i") {
    pixels.count = pixel_count(Cursor(value));
  } else if (type == "chlist") {
    pixels.bytes_each = bytes_per_pixel(Cursor(value));
  } else if (type == "stringvector") {
    check_strings(Cursor(value));
  } else if (type == "preview") {
    check_preview(Cursor(value));
  } else if (name == "compression") {
    check_compression(Cursor(value));
  }
}

}  // namespace

void check_scan_line_file(std::string_view content) {
  Cursor header(content);
  header.take(4);
  constexpr std::int32_t version_bits = 0xff;
  constexpr std::int32_t long_names = 0x400;
  const std::int32_t version = header.whole_number();
  if ((version & version_bits) != 2 || (version & ~(version_bits | long_names)) != 0) {
    fail("expected a scan-line image of one part, version 2");
  }
  Pixels pixels;
  for (std::string_view name = header.name(); !name.empty(); name = header.name()) {
    const std::string_view type = header.name();
    check_attribute(name, type, header.counted(), pixels);
  }
  if (!pixels.count || !pixels.bytes_each) fail("no data window or no channels in the header");
  constexpr std::uint64_t most_bytes_per_pixel = 1 << 20;
  if (*pixels.bytes_each > most_bytes_per_pixel) fail("too many channels");
  const std::uint64_t most = content.size() * most_expansion / (*pixels.bytes_each + 1);
  if (*pixels.count > most) {
    fail(fmt::format("{} pixels of {} bytes are declared, more than a file of {} bytes can hold",
                     *pixels.count, *pixels.bytes_each, content.size()));
  }
}

}  // namespace gonio::exr
