#include "apps/gonio/command.h"
namespace gonio::app {
void add_fit_command(CLI::App&, Invocation&) {}
}
