#include "tests/tensor_bytes.h"

namespace gonio::tests {
namespace {

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::string tensor_file_of(const std::vector<TensorField>& fields) {
  constexpr std::uint8_t float32 = 10;
  std::string header("tensor_file\0\1\0", 14);
  append(header, static_cast<std::uint32_t>(fields.size()));
  std::size_t offset = header.size();
  for (const TensorField& field : fields) {
    offset += 2 + field.name.size() + 2 + 1 + 8 + 8 * field.shape.size();
  }
  std::string data;
  for (const TensorField& field : fields) {
    append(header, static_cast<std::uint16_t>(field.name.size()));
    header += field.name;
    append(header, static_cast<std::uint16_t>(field.shape.size()));
    append(header, float32);
    append(header, static_cast<std::uint64_t>(offset + data.size()));
    for (const std::uint64_t size : field.shape) append(header, size);
    for (const float value : field.values) append(data, value);
  }
  return header + data;
}

}  // namespace gonio::tests
