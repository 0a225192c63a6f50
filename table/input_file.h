// The bytes of an input file: mapped where it is a regular file, read where it is a pipe.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::table {

/// A file's bytes, valid for the life of the object. The file must not shrink meanwhile.
class InputFile {
 public:
  /// Opens `path`. Throws FileError if it is missing, a folder, a device, empty or unreadable.
  explicit InputFile(const std::string& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::string_view bytes() const { return bytes_; }
  /// False for a pipe: its bytes are gone once they were read.
  bool is_regular() const { return is_regular_; }

 private:
  std::string_view bytes_;
  std::vector<char> read_;   // where the file could not be mapped
  void* mapping_ = nullptr;  // else of the size of bytes_
  bool is_regular_ = false;
};

}  // namespace gonio::table
