// gonio info: what a table is, before anything is fitted to it.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "apps/gonio/command.h"
#include "apps/gonio/info_report.h"
#include "apps/gonio/table_options.h"
#include "table/describe.h"
#include "table/file_error.h"
#include "table/read.h"

namespace gonio::app {
namespace {

struct InfoOptions {
  std::string table;
  TableOptions reading;
  bool json = false;
};

/// Throws if no sample is left: the table cannot be used, although it can be described.
void require_samples(const table::SampleTable& table, const table::Description& description) {
  if (description.used > 0) return;
  std::string reasons;
  for (std::size_t reason = 1; reason < table::mask_reason_count; ++reason) {
    if (description.masked[reason] == 0) continue;
    reasons += fmt::format(", {} masked as {}", description.masked[reason],
                           table::name(static_cast<table::MaskReason>(reason)));
  }
  throw table::FileError(
      fmt::format("{}: no sample is left to use: of {} samples{}; give it samples with a value and "
                  "both directions above the horizon",
                  table.provenance.path, description.samples, reasons));
}

void run_info(const InfoOptions& options) {
  table::SampleTable table = read_table(options.table, options.reading);
  table.provenance.sha256 = table::sha256_of_file(options.table);
  const table::Description description = table::describe(table);
  if (options.json) {
    print_json(info_json(table, description));
  } else {
    print(info_text(table, description));
  }
  require_samples(table, description);
}

}  // namespace

void add_info_command(CLI::App& app, Invocation& /*invocation*/) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* info = app.add_subcommand(
      "info", "What a table holds: ranges, coverage, plausibility, and what can be fitted from it");
  info->add_option("TABLE", options->table, "a measured table; the format is told by its content")
      ->required();
  add_table_options(*info, options->reading);
  info->add_flag("--json", options->json, "print JSON instead of text");
  info->callback([options] { run_info(*options); });
}

}  // namespace gonio::app
