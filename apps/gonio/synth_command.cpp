// gonio synth: the table that a virtual gonioreflectometer measures.
#include <fmt/format.h>

#include <memory>

#include "apps/gonio/command.h"
#include "apps/gonio/progress.h"
#include "instrument/synthesize.h"
#include "table/formats/gonio_csv.h"
#include "table/output_file.h"

namespace gonio::app {
namespace {

struct SynthOptions {
  std::string recipe;
  std::string output;
};

std::string plural(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

void synth(const SynthOptions& options) {
  const auto recipe = instrument::read_recipe(options.recipe);
  const auto table = [&] {
    const ProgressLine progress("measuring " + recipe.name);
    return instrument::synthesize(recipe);
  }();
  if (options.output.empty()) {
    table::write_gonio_csv(table, {}, print);
    return;
  }
  table::OutputFile file(options.output);
  table::write_gonio_csv(table, {}, [&](std::string_view piece) { file.write(piece); });
  file.commit();
  print_note(fmt::format("{}: {}, {}, {}, {}, {}", options.output, recipe.name,
                         plural(table.size(), "sample"), plural(table.channels.size(), "channel"),
                         plural(recipe.incidence_angles_deg.size(), "incidence angle"),
                         plural(recipe.sample_rotations_deg.size(), "rotation")));
}

}  // namespace

void add_synth_command(CLI::App& app, Invocation& /*invocation*/) {
  auto options = std::make_shared<SynthOptions>();
  CLI::App* command = app.add_subcommand(
      "synth", "Measure a material with a virtual gonioreflectometer: a table for tests and plans");
  command->add_option("RECIPE", options->recipe, "What to measure, and how noisily (JSON)")
      ->required();
  command->add_option("-o,--output", options->output,
                      "The table to write (gonio-table CSV); without it, to stdout");
  command->callback([options] { synth(*options); });
}

}  // namespace gonio::app
