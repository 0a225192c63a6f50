// Running a program other than gonio (run_gonio.h), and looking at what came of it.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/run_gonio.h"

namespace gonio::tests {

inline std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Runs the program with its arguments to its end.
inline CommandResult run_program(const std::vector<std::string>& words) {
  const TemporaryFolder folder;
  std::string command;
  for (const std::string& word : words) command += quoted(word) + " ";
  command += "</dev/null >" + quoted(folder / "out") + " 2>" + quoted(folder / "err");
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(folder / "out"),
          content_of(folder / "err")};
}

}  // namespace gonio::tests
