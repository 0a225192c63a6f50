#include "apps/gonio/table_input.h"

#include <fmt/format.h>

#include "apps/gonio/command.h"
#include "apps/gonio/progress.h"

namespace gonio::app {

table::SampleTable read_for_writing(const std::string& path, const TableOptions& options) {
  table::SampleTable table = [&] {
    const ProgressLine progress("reading " + path);
    return read_table(path, options, {.keep_angle_text = true});
  }();
  table.provenance.sha256 = table::sha256_of_file(path);
  for (const std::string& note : table.notes) print_note(fmt::format("{}: {}", path, note));
  return table;
}

}  // namespace gonio::app
