// OpenEXR files as bytes in memory: what is written beside and renamed, and what is mapped.
#pragma once

#include <ImfIO.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace gonio::exr {

/// Collects what OpenEXR writes.
class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : OStream("table") {}
  void write(const char* bytes, int count) override;
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::size_t position_ = 0;
};

/// Gives OpenEXR bytes that outlive it. Throws std::runtime_error for a read beyond their end.
class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::string_view bytes) : IStream("table"), bytes_(bytes) {}
  bool read(char* bytes, int count) override;
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
};

}  // namespace gonio::exr
