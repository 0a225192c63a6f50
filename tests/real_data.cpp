#include "tests/real_data.h"

#include <cstdlib>
#include <filesystem>

namespace gonio::tests {

std::string real_data(const std::string& relative) {
  const char* variable = std::getenv("GONIO_DATA");
  const std::filesystem::path folder =
      variable != nullptr && *variable != '\0'
          ? std::filesystem::path(variable)
          : std::filesystem::path(GONIO_SOURCE_DIR) / ".." / "shared" / "data";
  const std::filesystem::path path = folder / relative;
  return std::filesystem::exists(path) ? path.lexically_normal().string() : std::string();
}

}  // namespace gonio::tests
