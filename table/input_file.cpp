#include "table/input_file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <openssl/evp.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>
#include <system_error>

#include "table/file_error.h"
#include "table/read.h"

namespace gonio::table {

namespace {

[[noreturn]] void fail(const std::string& path, std::string_view found, std::string_view advice) {
  throw FileError(fmt::format("{}: {}: {}", path, found, advice));
}

[[noreturn]] void fail_by_errno(const std::string& path, int error) {
  if (error == ENOENT || error == ENOTDIR) fail(path, "no such file", "check the path");
  if (error == EISDIR) fail(path, "this is a folder", "name a file in it");
  fail(path, "cannot be read (" + std::generic_category().message(error) + ")",
       "check that it is a file and that you may read it");
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(const std::string& path) : value_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (value_ < 0) fail_by_errno(path, errno);
  }
  ~Descriptor() { close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int value() const { return value_; }

 private:
  int value_;
};

/// Fails for what a read would never end on or make no sense of, before it is opened.
struct stat usable_status(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) fail_by_errno(path, errno);
  if (S_ISDIR(status.st_mode)) fail_by_errno(path, EISDIR);
  if (S_ISBLK(status.st_mode)) fail(path, "this is a device", "name a file");
  return status;
}

std::vector<char> read_to_the_end(const Descriptor& file, const std::string& path) {
  constexpr std::size_t step = std::size_t{1} << 20;
  std::vector<char> bytes;
  std::size_t used = 0;
  while (true) {
    if (bytes.size() < used + step) bytes.resize(2 * used + step);
    const ssize_t count = ::read(file.value(), bytes.data() + used, bytes.size() - used);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail_by_errno(path, errno);
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace

InputFile::InputFile(const std::string& path) {
  const struct stat status = usable_status(path);
  const Descriptor file(path);
  is_regular_ = S_ISREG(status.st_mode);
  if (S_ISCHR(status.st_mode) && isatty(file.value()) == 0) {
    fail(path, "this is a device", "name a file");
  }
  if (is_regular_ && status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* address = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.value(), 0);
    if (address != MAP_FAILED) {
      mapping_ = address;
      bytes_ = {static_cast<const char*>(address), size};
      return;
    }
  }
  read_ = read_to_the_end(file, path);
  bytes_ = {read_.data(), read_.size()};
  if (bytes_.empty()) fail(path, "the file is empty", "name one with content");
}

InputFile::~InputFile() {
  if (mapping_ != nullptr) munmap(mapping_, bytes_.size());
}

std::string sha256_of_file(const std::string& path) {
  // Whatever read() took from a pipe is gone: another open would wait for ever or hash the rest.
  if (!S_ISREG(usable_status(path).st_mode)) return {};
  const InputFile file(path);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  if (EVP_Digest(file.bytes().data(), file.bytes().size(), digest.data(), &size, EVP_sha256(),
                 nullptr) != 1) {
    fail(path, "SHA-256 is not available from OpenSSL", "check the installation of OpenSSL");
  }
  std::string text;
  for (unsigned int i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

}  // namespace gonio::table
