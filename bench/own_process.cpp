#include "bench/own_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

namespace gonio::bench {
namespace {

constexpr const char* own_program = "/proc/self/exe";

std::vector<char*> pointers_to(std::vector<std::string>& strings) {
  std::vector<char*> pointers;
  for (std::string& string : strings) pointers.push_back(string.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// The environment with these variables in place of those of the same names.
std::vector<std::string> environment_with(std::span<const std::string> variables) {
  std::vector<std::string> all(variables.begin(), variables.end());
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view old(*variable);
    const std::string_view name = old.substr(0, old.find('=') + 1);
    bool is_replaced = false;
    for (const std::string& own : variables) is_replaced |= own.starts_with(name);
    if (!is_replaced) all.emplace_back(old);
  }
  return all;
}

class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) {
      throw std::system_error(errno, std::generic_category(), "no pipe");
    }
  }
  ~Pipe() {
    close(ends_[0]);
    close_write_end();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int write_end() const { return ends_[1]; }
  void close_write_end() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

  /// All until the last writer is gone.
  std::string content() const {
    std::string text;
    std::array<char, 4096> part{};
    for (;;) {
      const ssize_t size = read(ends_[0], part.data(), part.size());
      if (size > 0) {
        text.append(part.data(), std::size_t(size));
      } else if (size == 0 || errno != EINTR) {
        return text;
      }
    }
  }

 private:
  std::array<int, 2> ends_{};
};

pid_t start(std::span<const std::string> arguments, std::span<const std::string> variables,
            int output) {
  std::vector<std::string> words{std::filesystem::read_symlink(own_program).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> environment = environment_with(variables);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  pid_t process = 0;
  const int error = posix_spawn(&process, own_program, &actions, nullptr, pointers_to(words).data(),
                                pointers_to(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    throw std::system_error(error, std::generic_category(), "cannot start " + words.front());
  }
  return process;
}

int exit_status_of(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

ProcessResult run_own_process(std::span<const std::string> arguments,
                              std::span<const std::string> variables) {
  Pipe pipe;
  const pid_t process = start(arguments, variables, pipe.write_end());
  pipe.close_write_end();
  std::string out = pipe.content();
  return {exit_status_of(process), std::move(out)};
}

}  // namespace gonio::bench
