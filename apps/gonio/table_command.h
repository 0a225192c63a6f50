// gonio table: a table made of a table, one file per subcommand.
#pragma once

#include "apps/gonio/command.h"

namespace gonio::app {

void add_table_convert_command(CLI::App& table, Invocation& invocation);
void add_table_crop_command(CLI::App& table, Invocation& invocation);
void add_table_merge_command(CLI::App& table, Invocation& invocation);
void add_table_sample_command(CLI::App& table, Invocation& invocation);

}  // namespace gonio::app
