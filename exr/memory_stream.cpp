#include "exr/memory_stream.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace gonio::exr {

void MemoryOutput::write(const char* bytes, int count) {
  const auto size = static_cast<std::size_t>(count);
  text_.resize(std::max(text_.size(), position_ + size));
  std::memcpy(text_.data() + position_, bytes, size);
  position_ += size;
}

bool MemoryInput::read(char* bytes, int count) {
  const auto size = static_cast<std::size_t>(count);
  if (count < 0 || position_ > bytes_.size() || size > bytes_.size() - position_) {
    throw std::runtime_error(
        fmt::format("the file ends after {} bytes, expected more", bytes_.size()));
  }
  std::memcpy(bytes, bytes_.data() + position_, size);
  position_ += size;
  return position_ < bytes_.size();
}

}  // namespace gonio::exr
