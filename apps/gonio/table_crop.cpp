// gonio table crop: a part of a table.
#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <utility>

#include "apps/gonio/table_command.h"
#include "apps/gonio/table_input.h"
#include "apps/gonio/table_output.h"
#include "table/file_error.h"
#include "table/selection.h"

namespace gonio::app {
namespace {

struct CropOptions {
  std::string input;
  std::string max_theta;
  std::string wavelengths;
  bool drop_masked = false;
  TableOptions reading;
  TableOutput output;
};

/// LO:HI in nm as a choice of channels.
std::string channels_of(const std::string& wavelengths) {
  const std::size_t colon = wavelengths.find(':');
  if (colon != std::string::npos) {
    const auto lower = parse_number(std::string_view(wavelengths).substr(0, colon));
    const auto upper = parse_number(std::string_view(wavelengths).substr(colon + 1));
    if (lower && upper && *lower > 0 && *lower <= *upper) {
      return fmt::format("{}nm..{}nm", *lower, *upper);
    }
  }
  throw std::invalid_argument(fmt::format(
      "--wavelengths {}: expected LO:HI in nm, the lower one first, such as 450:650", wavelengths));
}

double max_theta_in(const std::string& text) {
  const auto degrees = parse_number(text);
  if (degrees && *degrees > 0 && *degrees <= 90) return *degrees;
  throw std::invalid_argument(
      fmt::format("--max-theta {}: expected an angle above 0 and up to 90 degrees", text));
}

void crop(CropOptions options) {
  check_output(options.output);
  refuse_overwriting(options.input, options.output.path);
  if (!options.wavelengths.empty()) {
    if (!options.reading.channels.empty()) {
      throw std::invalid_argument("--wavelengths and --channels: expected one of them");
    }
    options.reading.channels = channels_of(options.wavelengths);
  }
  table::SampleTable table = read_for_writing(options.input, options.reading);
  if (!options.max_theta.empty()) table::crop(table, max_theta_in(options.max_theta));
  if (options.drop_masked) {
    table::keep_samples(table,
                        [&](std::size_t i) { return table.mask[i] == table::MaskReason::none; });
  }
  if (table.size() == 0) {
    throw table::FileError(fmt::format("{}: no sample is left: raise --max-theta", options.input));
  }
  write_table(std::move(table), options.output);
}

}  // namespace

void add_table_crop_command(CLI::App& table, Invocation& /*invocation*/) {
  auto options = std::make_shared<CropOptions>();
  CLI::App* command = table.add_subcommand("crop", "Write a part of a table");
  command->add_option("IN", options->input, "a table, in any format")->required();
  command
      ->add_option("OUT", options->output.path, "the table to write: .csv, .exr, .binary, .xompt")
      ->required();
  command
      ->add_option("--max-theta", options->max_theta,
                   "keep what has both polar angles up to this, in degrees")
      ->type_name("DEG");
  command->add_option("--wavelengths", options->wavelengths, "keep the channels from LO to HI nm")
      ->type_name("LO:HI");
  command->add_flag("--drop-masked", options->drop_masked, "leave out what is masked");
  add_output_options(*command, options->output);
  add_table_options(*command, options->reading);
  command->callback([options] { crop(*options); });
}

}  // namespace gonio::app
