// Running the command that the build made, as a user would, and looking at what came of it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::tests {

/// A fresh folder, gone with its contents at the end of the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// The path of a file in the folder.
  std::string operator/(std::string_view name) const { return (path_ / name).string(); }
  /// Writes a file in the folder; its path.
  std::string write(std::string_view name, std::string_view content) const;
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

/// The whole content; a test fails if the file cannot be read.
std::string content_of(const std::string& path);

struct CommandResult {
  int exit_status;  // or -1 for a signal
  std::string out, err;
};

struct RunOptions {
  /// Set in the environment of the command, beside what is set here already.
  std::vector<std::pair<std::string, std::string>> environment{};
  /// Where stdout goes instead of into CommandResult::out.
  std::string stdout_path{};
};

/// Runs `gonio ARGUMENTS..` to its end, without a terminal.
CommandResult run_gonio(const std::vector<std::string>& arguments, const RunOptions& options = {});

/// Starts `gonio ARGUMENTS..` with its output thrown away; the caller waits for it.
pid_t start_gonio(const std::vector<std::string>& arguments);

}  // namespace gonio::tests
