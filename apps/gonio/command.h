// What the subcommands share: how they register, how they end, how they print.
//
// Results go to stdout, diagnostics to stderr. Exit status: 0 good; 1 the work was done but its
// result fails what was asked; 2 wrong usage (std::invalid_argument); 3 unusable input or output
// (table::FileError).
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::app {

/// What the process was started with and how it will end.
struct Invocation {
  std::string command_line;
  int exit_status = 0;
};

// Each adds its subcommand with a callback; the callback may set invocation.exit_status or throw.
void add_albedo_command(CLI::App& app, Invocation& invocation);
void add_convert_command(CLI::App& app, Invocation& invocation);
void add_eval_command(CLI::App& app, Invocation& invocation);
void add_export_command(CLI::App& app, Invocation& invocation);
void add_fit_command(CLI::App& app, Invocation& invocation);
void add_info_command(CLI::App& app, Invocation& invocation);
void add_lut_command(CLI::App& app, Invocation& invocation);
void add_models_command(CLI::App& app, Invocation& invocation);
void add_render_command(CLI::App& app, Invocation& invocation);
void add_synth_command(CLI::App& app, Invocation& invocation);
void add_table_command(CLI::App& app, Invocation& invocation);

/// A number that is the whole of a text, whatever the locale; nothing if it is none.
std::optional<double> parse_number(std::string_view text);

/// The word as a shell takes it, quoted where it has to be.
std::string shell_word(std::string_view word);

/// Throws std::invalid_argument if writing `output` would overwrite the file `source`.
void refuse_overwriting(const std::string& source, const std::string& output);

/// Writes text to stdout. Throws table::FileError when stdout cannot take it (a full disk).
void print(std::string_view text);
/// Prints indented JSON and a newline. Doubles read back to the same bits.
void print_json(const nlohmann::ordered_json& json);
/// Writes one line to stderr.
void print_note(std::string_view text);

}  // namespace gonio::app
