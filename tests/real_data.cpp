#include "tests/real_data.h"

#include <cstdlib>
#include <filesystem>

namespace gonio::tests {

namespace {

/// `relative` in the folder that the variable names, else in the one beside the project.
std::string in_folder(const char* variable, const char* beside, const std::string& relative) {
  const char* named = std::getenv(variable);
  const std::filesystem::path folder =
      named != nullptr && *named != '\0'
          ? std::filesystem::path(named)
          : std::filesystem::path(GONIO_SOURCE_DIR) / ".." / "shared" / beside;
  const std::filesystem::path path = folder / relative;
  return std::filesystem::exists(path) ? path.lexically_normal().string() : std::string();
}

}  // namespace

std::string real_data(const std::string& relative) {
  return in_folder("GONIO_DATA", "data", relative);
}

std::string peer_script(const std::string& name) { return in_folder("GONIO_PEERS", "peers", name); }

}  // namespace gonio::tests
