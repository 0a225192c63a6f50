// The main function of a study: errors as one line, and an exit status like gonio's.
#pragma once

#include <fmt/format.h>

#include <exception>
#include <stdexcept>
#include <string_view>

namespace gonio::bench {

/// The status that `run` returns; 2 for wrong usage (std::invalid_argument), 3 for whatever else it
/// throws.
inline int study_main(std::string_view name, int (*run)(int, char**), int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", name, error.what());
    return 3;
  }
}

}  // namespace gonio::bench
