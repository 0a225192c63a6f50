#include "apps/gonio/table_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "apps/gonio/command.h"
#include "table/channel_choice.h"
#include "table/file_error.h"
#include "table/formats/exr_table_writer.h"
#include "table/formats/gonio_csv.h"
#include "table/formats/merl_writer.h"
#include "table/formats/openmaterial_writer.h"
#include "table/output_file.h"

namespace gonio::app {
namespace {

using table::SampleTable;
using Write = std::function<void(std::string_view)>;
/// What was lost, a sentence each.
using Losses = std::vector<std::string>;

Losses write_csv(SampleTable& table, const TableOutput& /*output*/, const Write& write) {
  table::write_gonio_csv(table, {}, write);
  return table::csv_losses(table);
}

Losses write_exr(SampleTable& table, const TableOutput& output, const Write& write) {
  return table::write_exr_table(table, {.exact = !output.single}, write);
}

/// Puts channels of the names R, G and B into this order, which MERL's planes have.
void order_colours(SampleTable& table) {
  std::vector<std::size_t> order;
  for (const std::string_view colour : {"R", "G", "B"}) {
    const auto found = std::find(table.channels.begin(), table.channels.end(), colour);
    if (found == table.channels.end() || table.channels.size() != 3) return;
    order.push_back(static_cast<std::size_t>(found - table.channels.begin()));
  }
  keep_channels(table, order);
}

Losses write_merl_file(SampleTable& table, const TableOutput& /*output*/, const Write& write) {
  order_colours(table);
  return table::describe(table::write_merl(table, write));
}

Losses write_xompt(SampleTable& table, const TableOutput& output, const Write& write) {
  table::OpenMaterialMetadata metadata;
  if (!output.license.empty()) metadata.license = output.license;
  if (!output.copyright.empty()) metadata.copyright = output.copyright;
  if (!output.author.empty()) metadata.author = output.author;
  return table::describe(table::write_openmaterial(table, metadata, write));
}

struct Format {
  std::string_view name;
  std::string_view ending;
  Losses (*write)(SampleTable&, const TableOutput&, const Write&);
};

constexpr std::array formats{Format{"csv", ".csv", write_csv}, Format{"exr", ".exr", write_exr},
                             Format{"merl", ".binary", write_merl_file},
                             Format{"openmaterial", ".xompt", write_xompt}};

const Format& format_of(const TableOutput& output) {
  const std::string ending = std::filesystem::path(output.path).extension().string();
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const Format& format) {
    return output.format.empty() ? format.ending == ending : format.name == output.format;
  });
  if (found != formats.end()) return *found;
  if (!output.format.empty()) {
    throw std::invalid_argument(
        fmt::format("--to {}: expected csv, exr, merl or openmaterial", output.format));
  }
  throw std::invalid_argument(
      fmt::format("{}: the ending tells no format to write, expected .csv, .exr, .binary (MERL) or "
                  ".xompt (OpenMATERIAL): rename it, or say it with --to",
                  output.path));
}

}  // namespace

void add_output_options(CLI::App& command, TableOutput& output) {
  command
      .add_option("--to", output.format,
                  "csv, exr, merl or openmaterial; without it, as the name of the file ends")
      ->type_name("FORMAT");
  command.add_flag("--single", output.single,
                   "exr: numbers of 24 bits, half the size; without it, all 53 are kept");
  command.add_flag("--drop-sigma", output.drop_sigma, "write no standard deviations");
  command.add_flag("--drop-weight", output.drop_weight, "write no weights");
  command.add_option("--license", output.license, "openmaterial: the licence of the data")
      ->type_name("TEXT");
  command.add_option("--copyright", output.copyright, "openmaterial: whose they are")
      ->type_name("TEXT");
  command.add_option("--author", output.author, "openmaterial: who measured them")
      ->type_name("TEXT");
}

void check_output(const TableOutput& output) {
  if (output.path == "-") {
    throw std::invalid_argument(
        "-: a file is written, which appears when it is whole: name one, or /dev/stdout with --to");
  }
  const Format& format = format_of(output);
  const auto refuse = [&](std::string_view option, std::string_view only) {
    throw std::invalid_argument(fmt::format(
        "{}: it is for {} alone, the output is {}: leave it out", option, only, format.name));
  };
  if (output.single && format.name != "exr") refuse("--single", "exr");
  if (format.name == "openmaterial") return;
  if (!output.license.empty()) refuse("--license", "openmaterial");
  if (!output.copyright.empty()) refuse("--copyright", "openmaterial");
  if (!output.author.empty()) refuse("--author", "openmaterial");
}

void write_table(SampleTable table, const TableOutput& output) {
  const Format& format = format_of(output);
  if (output.drop_sigma) table.sigma.clear();
  if (output.drop_weight) table.weight.clear();
  table::OutputFile file(output.path);
  const Losses losses =
      format.write(table, output, [&](std::string_view piece) { file.write(piece); });
  file.commit();
  print_note(fmt::format("{}: {}, {} samples, {} channel{}", output.path, format.name, table.size(),
                         table.channels.size(), table.channels.size() == 1 ? "" : "s"));
  for (const std::string& loss : losses) print_note(fmt::format("{}: {}", output.path, loss));
}

}  // namespace gonio::app
