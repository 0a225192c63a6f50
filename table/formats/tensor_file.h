// The container of the RGL database: named arrays of numbers in one file.
//
//   "tensor_file\0", version (2 bytes: 1, 0), uint32 count of fields; per field: uint16 length of
//   its name, name, uint16 number of dimensions, uint8 type, uint64 offset, uint64 size of each
//   dimension. Little endian; arrays are row-major at their offsets.
//
// Source: the tensor files of Dupuy & Jakob, An Adaptive Parameterization for Efficient Material
// Acquisition and Rendering, 2018.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::table {

bool is_tensor_file(std::string_view content);

class TensorFile {
 public:
  /// Reads the fields' descriptions. `content` has to outlive the object; `path` is for messages.
  /// Throws FileError for what is cut off, for an array beyond the end of the file, for a name that
  /// stands twice.
  TensorFile(std::string_view content, std::string path);

  const std::string& path() const { return path_; }
  bool has(std::string_view name) const;
  /// The sizes of a field's dimensions. Throws FileError where there is no such field.
  const std::vector<std::size_t>& shape(std::string_view name) const;
  /// The numbers of a field, of the type float32 or float64. Throws FileError for another type,
  /// for another number of dimensions, or for a number that is not finite.
  std::vector<float> numbers(std::string_view name, std::size_t dimensions) const;
  /// Throws the FileError about a field.
  [[noreturn]] void refuse(std::string_view name, std::string_view problem) const;

 private:
  struct Field {
    std::string name;
    std::uint8_t type;
    std::vector<std::size_t> shape;
    std::string_view bytes;
  };
  const Field& field(std::string_view name) const;

  std::string path_;
  std::vector<Field> fields_;
};

}  // namespace gonio::table
