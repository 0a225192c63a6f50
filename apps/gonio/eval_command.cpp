#include "apps/gonio/command.h"
namespace gonio::app {
void add_eval_command(CLI::App&, Invocation&) {}
}
