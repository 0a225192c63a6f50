#include "apps/gonio/command.h"
namespace gonio::app {
void add_synth_command(CLI::App&, Invocation&) {}
}
