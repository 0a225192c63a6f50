// gonio: from measured reflectance to material parameters with error bars.
#include <fmt/core.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "apps/gonio/command.h"
#include "table/file_error.h"
#include "table/json_file.h"

namespace gonio::app {

namespace {

[[noreturn]] void fail_to_print() {
  throw table::FileError("stdout: could not be written: check the disk or the receiving program");
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

void refuse_overwriting(const std::string& source, const std::string& output) {
  std::error_code error;
  if (output.empty() || !std::filesystem::equivalent(source, output, error)) return;
  throw std::invalid_argument(
      fmt::format("-o {}: would overwrite what is read: name another file", output));
}

std::string shell_word(std::string_view word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) {
    return std::string(word);
  }
  std::string quoted = "'";
  for (const char c : word) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + '\'';
}

void print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) fail_to_print();
}

void print_json(const nlohmann::ordered_json& json) { print(table::json_text(json)); }

void print_note(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fputc('\n', stderr);
}

namespace {

/// The command line as it can be pasted back into a shell.
std::string quoted_command_line(int argc, char** argv) {
  std::string line = "gonio";
  for (int i = 1; i < argc; ++i) line += ' ' + shell_word(argv[i]);
  return line;
}

int run(int argc, char** argv) {
  Invocation invocation{.command_line = quoted_command_line(argc, argv)};
  CLI::App app{"From measured reflectance to material parameters with error bars."};
  app.name("gonio");
  app.set_version_flag("--version", "gonio " GONIO_VERSION);
  app.require_subcommand(1);
  add_info_command(app, invocation);
  add_fit_command(app, invocation);
  add_eval_command(app, invocation);
  add_albedo_command(app, invocation);
  add_convert_command(app, invocation);
  add_export_command(app, invocation);
  add_lut_command(app, invocation);
  add_render_command(app, invocation);
  add_models_command(app, invocation);
  add_synth_command(app, invocation);
  add_table_command(app, invocation);
  const std::vector<CLI::App*> commands = app.get_subcommands([](CLI::App*) { return true; });
  if (argc > 1 && argv[1][0] != '-' &&
      std::none_of(commands.begin(), commands.end(),
                   [&](const CLI::App* command) { return command->get_name() == argv[1]; })) {
    print_note(
        fmt::format("gonio: there is no command '{}' (gonio --help says what there is)", argv[1]));
    return 2;
  }
  try {
    app.parse(argc, argv);
    if (std::fflush(stdout) != 0) fail_to_print();
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    print_note(fmt::format("gonio: {} (gonio --help says what there is)", error.what()));
    return 2;
  }
  return invocation.exit_status;
}

}  // namespace
}  // namespace gonio::app

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // What one pass over a table frees the next one needs: not to be given back in between.
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
#endif
  // A file size limit and a closed pipe are reported like a full disk, not by a signal.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return gonio::app::run(argc, argv);
  } catch (const std::invalid_argument& error) {
    gonio::app::print_note(fmt::format("gonio: {}", error.what()));
    return 2;
  } catch (const std::bad_alloc&) {
    gonio::app::print_note("gonio: out of memory");
    return 3;
  } catch (const std::exception& error) {
    gonio::app::print_note(fmt::format("gonio: {}", error.what()));
    return 3;
  }
}
