// gonio table sample: a gridded table's values at any directions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "apps/gonio/command.h"
#include "apps/gonio/progress.h"
#include "apps/gonio/table_command.h"
#include "apps/gonio/table_options.h"
#include "table/channel_choice.h"
#include "table/formats/foreign_csv.h"
#include "table/formats/gonio_csv.h"
#include "table/output_file.h"
#include "table/parallel.h"

namespace gonio::app {
namespace {

struct SampleOptions {
  std::string input;
  std::string directions;
  std::string channels;
  std::string output;
  TableOptions at;  // how the directions are read
};

/// Gives every direction of `samples` its values.
void fill(const table::GriddedTable& grid, table::SampleTable& samples) {
  constexpr std::size_t block = 1024;
  samples.name = grid.name;
  samples.channels = grid.channels;
  samples.values.assign(grid.channels.size(), std::vector<double>(samples.size()));
  const std::size_t blocks = (samples.size() + block - 1) / block;
  table::parallel_for(blocks, 0, [&](std::size_t b) {
    std::vector<double> f_r(grid.channels.size());
    for (std::size_t i = b * block; i < std::min((b + 1) * block, samples.size()); ++i) {
      std::fill(f_r.begin(), f_r.end(), std::numeric_limits<double>::quiet_NaN());
      if (samples.mask[i] != table::MaskReason::horizon)
        grid.f_r(samples.wi[i], samples.wo[i], f_r);
      for (std::size_t c = 0; c < f_r.size(); ++c) samples.values[c][i] = f_r[c];
    }
  });
}

std::size_t empty_rows(const table::SampleTable& samples) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    count += std::all_of(samples.values.begin(), samples.values.end(),
                         [&](const auto& values) { return std::isnan(values[i]); })
                 ? 1U
                 : 0U;
  }
  return count;
}

void write(const table::SampleTable& samples, const std::string& output) {
  if (output.empty()) return table::write_gonio_csv(samples, {}, print);
  table::OutputFile file(output);
  table::write_gonio_csv(samples, {}, [&](std::string_view piece) { file.write(piece); });
  file.commit();
}

void sample(const SampleOptions& options) {
  refuse_overwriting(options.input, options.output);
  refuse_overwriting(options.directions, options.output);
  const table::GriddedTable grid = table::read_gridded(options.input);
  table::SampleTable samples =
      table::read_directions(options.directions, reading_options(options.at));
  {
    const ProgressLine progress("sampling " + options.input);
    fill(grid, samples);
  }
  if (!options.channels.empty()) {
    keep_channels(samples, table::chosen_channels(samples.channels, options.channels));
  }
  write(samples, options.output);
  for (const std::string& note : grid.notes) {
    print_note(fmt::format("{}: {}", options.input, note));
  }
  if (const std::size_t empty = empty_rows(samples); empty > 0) {
    print_note(fmt::format("{} of {} directions lie outside of what was measured: empty fields",
                           empty, samples.size()));
  }
}

}  // namespace

void add_table_sample_command(CLI::App& table, Invocation& /*invocation*/) {
  auto options = std::make_shared<SampleOptions>();
  CLI::App* command = table.add_subcommand(
      "sample", "A gridded table's values at any directions: CSV, one row per direction, in order");
  command
      ->add_option("IN", options->input, "a gridded table: MERL, RGL, Zemax, Klems, OpenMATERIAL")
      ->required();
  command
      ->add_option("--at", options->directions,
                   "the directions: CSV with columns theta_i, phi_i, theta_o, phi_o; others are "
                   "passed over")
      ->type_name("CSV")
      ->required();
  command->add_option("--channels", options->channels, "the channels to write")
      ->type_name("NAME,..");
  command->add_option("-o,--output", options->output, "the CSV to write; without it, to stdout")
      ->type_name("CSV");
  command->add_option("--columns", options->at.columns, "the columns of the directions, in order")
      ->type_name("NAME,..");
  command->add_option("--angles", options->at.angles, "what the directions are in: deg or rad")
      ->type_name("UNIT");
  command->callback([options] { sample(*options); });
}

}  // namespace gonio::app
