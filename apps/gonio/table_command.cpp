// gonio table: tables from tables.
#include "apps/gonio/table_command.h"

namespace gonio::app {

void add_table_command(CLI::App& app, Invocation& invocation) {
  CLI::App* table = app.add_subcommand(
      "table", "Tables from tables: convert, crop or merge them, or sample one at any directions");
  table->require_subcommand(1);
  add_table_convert_command(*table, invocation);
  add_table_crop_command(*table, invocation);
  add_table_merge_command(*table, invocation);
  add_table_sample_command(*table, invocation);
}

}  // namespace gonio::app
