// Where real measurements are: $GONIO_DATA, else ../shared/data beside the project. They are read
// in place and never copied into the project; tests skip, saying so, where they are absent.
#pragma once

#include <string>

namespace gonio::tests {

/// The path of `relative` ("paints/C8_Silver.astm") in the data folder, or empty if it is absent.
std::string real_data(const std::string& relative);

/// The path of a rival's script in $GONIO_PEERS, else in ../shared/peers, or empty if it is absent.
std::string peer_script(const std::string& name);

}  // namespace gonio::tests

/// Sets `path` to real data, or skips the test, naming what is missing.
#define GONIO_REAL_DATA_OR_SKIP(path, relative)                                \
  const std::string path = ::gonio::tests::real_data(relative);                \
  if ((path).empty()) {                                                        \
    GTEST_SKIP() << "real data '" << (relative)                                \
                 << "' not found: set GONIO_DATA to the folder that holds it"; \
  }
