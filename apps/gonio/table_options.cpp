#include "apps/gonio/table_options.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "apps/gonio/command.h"
#include "brdf/direction.h"
#include "table/channel_choice.h"
#include "table/masks.h"

namespace gonio::app {
namespace {

constexpr std::string_view group = "The table";

template <class Value, std::size_t N>
std::optional<Value> value_named(std::string_view option, const std::string& text,
                                 const std::array<Value, N>& values) {
  if (text.empty()) return std::nullopt;
  std::string known;
  for (const Value value : values) {
    if (text == name(value)) return value;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", name(value));
  }
  throw std::invalid_argument(fmt::format("{} {}: expected one of {}", option, text, known));
}

double angle_in(std::string_view option, std::string_view text) {
  const auto degrees = parse_number(text);
  if (degrees && *degrees > 0 && *degrees <= 180) return *degrees;
  throw std::invalid_argument(
      fmt::format("{} {}: expected an angle above 0 in degrees, such as 5", option, text));
}

struct BlindSpot {
  brdf::Direction<double> wo;
  double degrees;
};

BlindSpot blind_spot_in(std::string_view text) {
  const std::size_t first = text.find(',');
  const std::size_t second = first == std::string_view::npos ? first : text.find(',', first + 1);
  if (second == std::string_view::npos) {
    throw std::invalid_argument(
        fmt::format("--mask-wo {}: expected THETA,PHI,RADIUS in degrees, such as 30,180,5", text));
  }
  const auto theta = parse_number(text.substr(0, first));
  const auto phi = parse_number(text.substr(first + 1, second - first - 1));
  if (!theta || !phi || !(*theta >= 0 && *theta <= 90) || !std::isfinite(*phi)) {
    throw std::invalid_argument(
        fmt::format("--mask-wo {}: expected THETA,PHI,RADIUS in degrees with theta from 0 to 90, "
                    "such as 30,180,5",
                    text));
  }
  return {brdf::direction_from_degrees(*theta, *phi),
          angle_in("--mask-wo", text.substr(second + 1))};
}

}  // namespace

void add_reading_options(CLI::App& command, TableOptions& options) {
  command
      .add_option("--columns", options.columns,
                  "what the columns of a CSV hold that does not say it, in their order: theta_i, "
                  "phi_i, theta_o, phi_o, channels, sigma_<channel>, weight; - passes one over, "
                  "phi_i=0 stands for one that is not there")
      ->type_name("NAME,..")
      ->group(std::string(group));
  command
      .add_option("--quantity", options.quantity,
                  "what its numbers are: brdf, brdf_cos or reflectance_factor")
      ->type_name("Q")
      ->group(std::string(group));
  command.add_option("--angles", options.angles, "what its angles are in: deg or rad")
      ->type_name("UNIT")
      ->group(std::string(group));
  command.add_option("--material", options.material, "which material of a file of several (CUReT)")
      ->type_name("N")
      ->group(std::string(group));
}

void add_table_options(CLI::App& command, TableOptions& options) {
  add_reading_options(command, options);
  command
      .add_option("--channels", options.channels,
                  "the channels to take: names, ranges (R..B, 500nm..600nm) or wavelengths (550nm)")
      ->type_name("NAME,..")
      ->group(std::string(group));
  command
      .add_option("--mask-retro", options.mask_retro,
                  "leave out what is seen from nearer to the light than this, where the instrument "
                  "shades its own beam")
      ->type_name("DEG")
      ->group(std::string(group));
  command
      .add_option("--mask-wo", options.mask_wo,
                  "leave out what is seen from within RADIUS of a direction, a camera's blind spot")
      ->allow_extra_args(false)
      ->type_name("THETA,PHI,RADIUS")
      ->group(std::string(group));
}

table::ReadOptions reading_options(const TableOptions& options, table::ReadOptions base) {
  using table::AngleUnit;
  using table::Quantity;
  base.columns = options.columns;
  base.quantity =
      value_named("--quantity", options.quantity,
                  std::array{Quantity::brdf, Quantity::brdf_cos, Quantity::reflectance_factor});
  base.angles =
      value_named("--angles", options.angles, std::array{AngleUnit::degrees, AngleUnit::radians});
  if (!options.material.empty()) {
    const auto number = parse_number(options.material);
    if (!number || *number != std::floor(*number) || !(*number >= 1 && *number <= 1e9)) {
      throw std::invalid_argument(fmt::format(
          "--material {}: expected the number of a material, from 1 on", options.material));
    }
    base.material = static_cast<int>(*number);
  }
  return base;
}

void take_part(table::SampleTable& table, const TableOptions& options) {
  if (!options.channels.empty()) {
    keep_channels(table, table::chosen_channels(table.channels, options.channels));
  }
  if (!options.mask_retro.empty()) {
    const double degrees = angle_in("--mask-retro", options.mask_retro);
    const std::size_t count = table::mask_retro(table, degrees);
    table.notes.push_back(
        fmt::format("{} samples seen from less than {:g} deg beside the light are masked as retro",
                    count, degrees));
  }
  for (const std::string& text : options.mask_wo) {
    const BlindSpot spot = blind_spot_in(text);
    const std::size_t count = table::mask_blind_spot(table, spot.wo, spot.degrees);
    table.notes.push_back(
        fmt::format("{} samples seen from within {:g} deg of a direction (--mask-wo {}) are masked "
                    "as blind-spot",
                    count, spot.degrees, text));
  }
}

table::SampleTable read_table(const std::string& path, const TableOptions& options,
                              const table::ReadOptions& base) {
  table::SampleTable table = table::read(path, reading_options(options, base));
  take_part(table, options);
  return table;
}

}  // namespace gonio::app
