#include "table/output_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <random>
#include <system_error>
#include <tuple>
#include <utility>

#include "table/file_error.h"

namespace gonio::table {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_size = std::size_t{1} << 20;

std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void fail_to_open(const std::string& path, const fs::path& folder, int error) {
  std::error_code ignored;
  if (!fs::exists(folder, ignored)) {
    throw FileError(fmt::format("{}: the folder '{}' does not exist: create it or name another",
                                path, folder.string()));
  }
  throw FileError(
      fmt::format("{}: cannot be created in the folder '{}' ({}): check that you may write there",
                  path, folder.string(), reason(error)));
}

/// The file that `path` leads to through symbolic links, which need not exist.
fs::path follow_links(const std::string& path) {
  constexpr int most_links = 40;
  fs::path target(path);
  for (int i = 0; i < most_links; ++i) {
    std::error_code error;
    const fs::path link = fs::read_symlink(target, error);
    if (error) return target;
    target = target.parent_path() / link;  // an absolute link replaces the folder
  }
  throw FileError(fmt::format("{}: too many symbolic links: name the file itself", path));
}

/// /dev/stdout and its like lead to whatever the process holds open: replacing a file there would
/// take it away from the process.
bool names_an_open_descriptor(const std::string& path) {
  return path == "/dev/stdout" || path == "/dev/stderr" || path.starts_with("/dev/fd/") ||
         path.starts_with("/proc/");
}

/// Creates a hidden file beside `target` that no one else has, with the permissions of a new one.
std::pair<int, fs::path> create_beside(const fs::path& target, const std::string& path) {
  constexpr int most_attempts = 100;
  constexpr std::size_t longest_stem = 200;  // of the 255 bytes of a file name
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const std::string stem = target.filename().string().substr(0, longest_stem);
  std::random_device random;
  for (int i = 0; i < most_attempts; ++i) {
    const fs::path beside = folder / fmt::format(".{}.{:08x}.tmp", stem, random());
    const int descriptor = open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) return {descriptor, beside};
    if (errno != EEXIST) fail_to_open(path, folder, errno);
  }
  fail_to_open(path, folder, EEXIST);
}

/// Gives the new file the owner and permissions of the one that it will replace. A user who is
/// not allowed to give the file away keeps it.
bool take_over_permissions(int descriptor, const struct stat& old) {
  if (fchown(descriptor, old.st_uid, old.st_gid) != 0 && errno != EPERM) return false;
  return fchmod(descriptor, old.st_mode & 07777) == 0;
}

/// So that the new name outlasts a power cut; a file system that cannot do it is no error.
void sync_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(path) {
  struct stat old {};
  const bool exists = stat(path.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) {
    throw FileError(fmt::format("{}: this is a folder: name a file in it", path));
  }
  if (exists && (!S_ISREG(old.st_mode) || names_an_open_descriptor(path))) {
    target_ = path;
    descriptor_ = open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    if (descriptor_ < 0) fail("opened for writing");
    return;
  }
  target_ = follow_links(path);
  if (!target_.has_filename()) {
    throw FileError(fmt::format("'{}' names no file: give a file name", path));
  }
  if (exists && access(target_.c_str(), W_OK) != 0) {
    throw FileError(
        fmt::format("{}: the file is write-protected ({}): make it writable or name "
                    "another",
                    path, reason(errno)));
  }
  std::tie(descriptor_, beside_) = create_beside(target_, path);
  if (exists && !take_over_permissions(descriptor_, old)) fail("given the old file's permissions");
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= buffer_size) flush();
}

void OutputFile::commit() {
  flush();
  const bool is_direct = beside_.empty();
  if (!is_direct && fsync(descriptor_) != 0) fail("written to disk");
  if (close(std::exchange(descriptor_, -1)) != 0) fail("closed");
  if (is_direct) return;
  if (std::rename(beside_.c_str(), target_.c_str()) != 0) fail("renamed into place");
  beside_.clear();
  sync_folder(target_);
}

void OutputFile::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty()) {
    const ssize_t count = ::write(descriptor_, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("written");
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  buffer_.clear();
}

void OutputFile::discard() noexcept {
  if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
  if (!beside_.empty()) unlink(beside_.c_str());
  beside_.clear();
}

void OutputFile::fail(const std::string& doing) {
  const int error = errno;
  discard();
  throw FileError(fmt::format("{}: could not be {} ({}): {}", path_, doing, reason(error),
                              error == ENOSPC || error == EFBIG || error == EDQUOT
                                  ? "free some space or write elsewhere"
                                  : "check the path and what you may write"));
}

void write_file(const std::string& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace gonio::table
