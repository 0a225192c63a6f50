// This program once more, as a process of its own with another environment: the choice of a Vulkan
// driver, which is read once in a process.
#pragma once

#include <span>
#include <string>

namespace gonio::bench {

struct ProcessResult {
  int exit_status;  // or -1 for one that a signal ended
  std::string out;  // its standard output; its standard error is this process's
};

/// Runs it and waits for its end. `variables`: NAME=VALUE each, before those of this process.
/// Throws std::runtime_error if it cannot be started.
ProcessResult run_own_process(std::span<const std::string> arguments,
                              std::span<const std::string> variables);

}  // namespace gonio::bench
