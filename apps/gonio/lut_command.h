// The two ways of `gonio lut`.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/gonio/command.h"

namespace gonio::app {

void add_lut_bake_command(CLI::App& lut, Invocation& invocation);
void add_lut_check_command(CLI::App& lut, Invocation& invocation);

}  // namespace gonio::app
