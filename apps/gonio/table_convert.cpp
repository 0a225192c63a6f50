// gonio table convert: a table in another format.
#include <memory>
#include <utility>

#include "apps/gonio/table_command.h"
#include "apps/gonio/table_input.h"
#include "apps/gonio/table_output.h"

namespace gonio::app {
namespace {

struct ConvertOptions {
  std::string input;
  TableOptions reading;
  TableOutput output;
};

void convert(const ConvertOptions& options) {
  check_output(options.output);
  refuse_overwriting(options.input, options.output.path);
  write_table(read_for_writing(options.input, options.reading), options.output);
}

}  // namespace

void add_table_convert_command(CLI::App& table, Invocation& /*invocation*/) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = table.add_subcommand(
      "convert", "Write a table in another format, and say what that format cannot hold");
  command->add_option("IN", options->input, "a table, in any format")->required();
  command
      ->add_option("OUT", options->output.path, "the table to write: .csv, .exr, .binary, .xompt")
      ->required();
  add_output_options(*command, options->output);
  add_table_options(*command, options->reading);
  command->callback([options] { convert(*options); });
}

}  // namespace gonio::app
