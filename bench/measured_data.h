// Where a study finds real measurements: where the user says, else in the data folder.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace gonio::bench {

/// The folder of measurements that $GONIO_DATA names, else ../shared/data, from where the command
/// is run.
inline std::filesystem::path data_folder() {
  const char* named = std::getenv("GONIO_DATA");
  return named != nullptr && *named != '\0' ? named : "../shared/data";
}

}  // namespace gonio::bench
