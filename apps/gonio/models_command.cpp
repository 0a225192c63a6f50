#include "apps/gonio/command.h"
namespace gonio::app {
void add_models_command(CLI::App&, Invocation&) {}
}
