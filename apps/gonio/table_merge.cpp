// gonio table merge: one table of several.
#include <memory>
#include <utility>
#include <vector>

#include "apps/gonio/table_command.h"
#include "apps/gonio/table_input.h"
#include "apps/gonio/table_output.h"
#include "table/selection.h"

namespace gonio::app {
namespace {

struct MergeOptions {
  std::vector<std::string> inputs;
  TableOptions reading;
  TableOutput output;
};

void merge(const MergeOptions& options) {
  check_output(options.output);
  std::vector<table::SampleTable> tables;
  for (const std::string& input : options.inputs) {
    refuse_overwriting(input, options.output.path);
    tables.push_back(read_for_writing(input, options.reading));
    if (options.output.drop_sigma) tables.back().sigma.clear();
    if (options.output.drop_weight) tables.back().weight.clear();
  }
  const bool is_weighted = tables.size() > 1 && tables.front().has_weight();
  table::SampleTable merged = table::merge(tables);
  if (is_weighted) {
    print_note(
        "warning: the weights of each table are kept as they are: solid angles of different grids "
        "count as the grids overlap");
  }
  write_table(std::move(merged), options.output);
}

}  // namespace

void add_table_merge_command(CLI::App& table, Invocation& /*invocation*/) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = table.add_subcommand(
      "merge", "Write one table with the samples of several, which measured one material");
  command->add_option("IN", options->inputs, "tables, in any formats, with the same channels")
      ->required();
  command->add_option("-o,--output", options->output.path, "the table to write")
      ->type_name("FILE")
      ->required();
  add_output_options(*command, options->output);
  add_table_options(*command, options->reading);
  command->callback([options] { merge(*options); });
}

}  // namespace gonio::app
