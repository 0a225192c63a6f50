// Which of CUReT's two files a text is, and where the other one lies.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "table/input_file.h"

namespace gonio::table {

enum class CuretKind { none, directions, measurements };

/// Told by the first rows of the content; see is_curet().
CuretKind curet_kind(std::string_view content);

/// The other file of a pair, found beside the one that is given; see read_curet_file().
class CuretPartner {
 public:
  /// `content` is one of the two. Throws FileError if the other one is not found.
  CuretPartner(std::string_view content, const std::string& path);

  const std::string& path() const { return path_; }
  /// Valid for the life of the object.
  std::string_view content() const { return file_->bytes(); }

 private:
  std::string path_;
  std::unique_ptr<const InputFile> file_;
};

}  // namespace gonio::table
