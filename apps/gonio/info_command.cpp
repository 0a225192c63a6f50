#include "apps/gonio/command.h"
namespace gonio::app {
void add_info_command(CLI::App&, Invocation&) {}
}
