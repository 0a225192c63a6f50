#include "shader/chip_environment.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace gonio::shader {
namespace {

namespace fs = std::filesystem;

std::string variable_or(const char* name, const std::string& otherwise) {
  const char* const value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : otherwise;
}

bool is_of_radv(const fs::path& manifest) {
  const std::string name = manifest.filename().string();
  return name.starts_with("radeon_icd") && name.ends_with(".json");
}

}  // namespace

std::vector<fs::path> driver_folders() {
  const std::string home = variable_or("HOME", "");
  const std::array<std::string, 5> lists{
      variable_or("XDG_CONFIG_HOME", home + "/.config"), variable_or("XDG_CONFIG_DIRS", "/etc/xdg"),
      "/usr/local/etc:/etc", variable_or("XDG_DATA_HOME", home + "/.local/share"),
      variable_or("XDG_DATA_DIRS", "/usr/local/share:/usr/share")};
  std::vector<fs::path> folders;
  for (std::string_view list : lists) {
    while (!list.empty()) {
      const std::size_t end = std::min(list.find(':'), list.size());
      folders.push_back(fs::path(list.substr(0, end)) / "vulkan" / "icd.d");
      list.remove_prefix(std::min(end + 1, list.size()));
    }
  }
  return folders;
}

std::vector<fs::path> radv_manifests(const std::vector<fs::path>& folders) {
  std::vector<fs::path> manifests;
  for (const fs::path& folder : folders) {
    std::vector<fs::path> here;
    std::error_code no_folder;
    for (const auto& entry : fs::directory_iterator(folder, no_folder)) {
      if (is_of_radv(entry.path())) here.push_back(entry.path());
    }
    std::sort(here.begin(), here.end());
    manifests.insert(manifests.end(), here.begin(), here.end());
  }
  return manifests;
}

std::vector<std::string> chip_environment(const std::string& chip,
                                          std::span<const fs::path> manifests) {
  std::string list;
  for (const fs::path& path : manifests) list += (list.empty() ? "" : ":") + path.string();
  // Newer loaders read the first, older ones the second; older versions of Mesa the third, newer
  // ones the fourth. The last silences a remark on stderr.
  return {"VK_DRIVER_FILES=" + list, "VK_ICD_FILENAMES=" + list, "RADV_FORCE_FAMILY=" + chip,
          "AMD_FORCE_FAMILY=" + chip, "MESA_VK_IGNORE_CONFORMANCE_WARNING=true"};
}

}  // namespace gonio::shader
