// gonio lut: look-up tables for shaders.
#include "apps/gonio/lut_command.h"

namespace gonio::app {

void add_lut_command(CLI::App& app, Invocation& invocation) {
  CLI::App* lut = app.add_subcommand(
      "lut", "Look-up tables for shaders: bake one, or check one against a material");
  lut->require_subcommand(1);
  add_lut_bake_command(*lut, invocation);
  add_lut_check_command(*lut, invocation);
}

}  // namespace gonio::app
