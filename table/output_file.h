// Files that are written beside their target and renamed into place, so that a killed run leaves
// either the old file or the new one.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::table {

/// An output file that appears under its name only with commit(). Without it, nothing is left.
/// A target that exists and is no regular file (a pipe, /dev/stdout) is written directly; a
/// symbolic link is followed, so that the file it names is replaced and not the link.
class OutputFile {
 public:
  /// Opens a temporary file beside `path`. Throws FileError if that is not possible.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends `text`; buffered. Throws FileError (disk full, ...) and leaves no file.
  void write(std::string_view text);
  /// Flushes to disk and renames into place. Throws FileError and leaves no file.
  void commit();

 private:
  void flush();
  void discard() noexcept;
  [[noreturn]] void fail(const std::string& doing);

  std::string path_;              // as the user named it
  std::filesystem::path target_;  // links resolved
  std::filesystem::path beside_;  // the temporary file; empty when writing directly
  std::string buffer_;
  int descriptor_ = -1;
};

/// Writes `text` to `path` as one OutputFile.
void write_file(const std::string& path, std::string_view text);

}  // namespace gonio::table
