#include "table/formats/tensor_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "table/file_error.h"
#include "table/formats/text_lines.h"

namespace gonio::table {

namespace {

constexpr std::string_view signature("tensor_file\0", 12);
constexpr std::uint8_t float32 = 10;
constexpr std::uint8_t float64 = 11;
/// Far more than any file has; names are compared with each other.
constexpr std::uint32_t most_fields = 1000;

/// The bytes of a number of each type; 0 for none.
std::size_t size_of_type(std::uint8_t type) {
  constexpr std::array<std::uint8_t, 12> sizes{0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
  return type < sizes.size() ? sizes[type] : 0;
}

/// Walks over the little-endian description.
class Cursor {
 public:
  Cursor(std::string_view content, const std::string& path) : content_(content), path_(path) {}

  std::string_view take(std::size_t count) {
    if (count > content_.size() - at_) {
      throw FileError(
          fmt::format("{}: byte {}: the description of the fields is cut off: fetch the file anew",
                      path_, content_.size()));
    }
    const std::string_view taken = content_.substr(at_, count);
    at_ += count;
    return taken;
  }
  template <class T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }

 private:
  std::string_view content_;
  const std::string& path_;
  std::size_t at_ = 0;
};

/// The product of the sizes and of `size`; nothing if it overflows.
std::optional<std::uint64_t> product_of(const std::vector<std::uint64_t>& sizes,
                                        std::uint64_t size) {
  std::uint64_t product = size;
  for (const std::uint64_t factor : sizes) {
    if (factor != 0 && product > UINT64_MAX / factor) return std::nullopt;
    product *= factor;
  }
  return product;
}

}  // namespace

bool is_tensor_file(std::string_view content) { return content.starts_with(signature); }

TensorFile::TensorFile(std::string_view content, std::string path) : path_(std::move(path)) {
  Cursor cursor(content, path_);
  cursor.take(signature.size());
  const auto major = cursor.number<std::uint8_t>();
  const auto minor = cursor.number<std::uint8_t>();
  if (major != 1 || minor != 0) {
    throw FileError(fmt::format("{}: byte 12: found version {}.{}, expected 1.0: convert the file",
                                path_, major, minor));
  }
  const auto count = cursor.number<std::uint32_t>();
  if (count > most_fields) {
    throw FileError(
        fmt::format("{}: byte 14: found {} fields, expected {} at most: fetch the file "
                    "anew",
                    path_, count, most_fields));
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    Field field;
    field.name = cursor.take(cursor.number<std::uint16_t>());
    const auto dimensions = cursor.number<std::uint16_t>();
    field.type = cursor.number<std::uint8_t>();
    const auto offset = cursor.number<std::uint64_t>();
    std::vector<std::uint64_t> sizes;
    for (std::uint16_t d = 0; d < dimensions; ++d) sizes.push_back(cursor.number<std::uint64_t>());
    const auto bytes = product_of(sizes, size_of_type(field.type));
    if (size_of_type(field.type) == 0) {
      refuse(field.name, fmt::format("found type {}, expected 1 to 11", field.type));
    }
    if (!bytes || offset > content.size() || *bytes > content.size() - offset) {
      refuse(field.name, fmt::format("found an array of {} numbers at byte {}, expected one that "
                                     "ends within the file of {} bytes: fetch the file anew",
                                     fmt::join(sizes, " x "), offset, content.size()));
    }
    if (has(field.name)) refuse(field.name, "the field stands twice, expected each name once");
    field.shape.assign(sizes.begin(), sizes.end());
    field.bytes = content.substr(offset, *bytes);
    fields_.push_back(std::move(field));
  }
}

bool TensorFile::has(std::string_view name) const {
  return std::any_of(fields_.begin(), fields_.end(),
                     [&](const Field& field) { return field.name == name; });
}

const TensorFile::Field& TensorFile::field(std::string_view name) const {
  const auto found = std::find_if(fields_.begin(), fields_.end(),
                                  [&](const Field& field) { return field.name == name; });
  if (found == fields_.end()) refuse(name, "the field is missing: name a file of the RGL database");
  return *found;
}

const std::vector<std::size_t>& TensorFile::shape(std::string_view name) const {
  return field(name).shape;
}

std::vector<float> TensorFile::numbers(std::string_view name, std::size_t dimensions) const {
  const Field& found = field(name);
  if (found.shape.size() != dimensions) {
    refuse(name, fmt::format("found {} dimensions, expected {}", found.shape.size(), dimensions));
  }
  if (found.type != float32 && found.type != float64) {
    refuse(name, fmt::format("found type {}, expected 10 or 11, numbers of 32 or 64 bits with a "
                             "floating point",
                             found.type));
  }
  const std::size_t size = size_of_type(found.type);
  std::vector<float> numbers(found.bytes.size() / size);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (found.type == float32) {
      std::memcpy(&numbers[i], found.bytes.data() + i * size, size);
    } else {
      double number = 0;
      std::memcpy(&number, found.bytes.data() + i * size, size);
      numbers[i] = static_cast<float>(number);
    }
    if (!std::isfinite(numbers[i])) {
      refuse(name, fmt::format("number {}: found {}, expected a finite one", i, numbers[i]));
    }
  }
  return numbers;
}

void TensorFile::refuse(std::string_view name, std::string_view problem) const {
  throw FileError(fmt::format("{}: field {}: {}", path_, quoted(name), problem));
}

}  // namespace gonio::table
